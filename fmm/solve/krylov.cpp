#include "fmm/solve/krylov.h"
#include <Eigen/IterativeLinearSolvers>

namespace pointgi {
struct Transport; // I - rho H, as Eigen's solvers take a matrix
} // namespace pointgi

namespace Eigen::internal {
template <>
struct traits<pointgi::Transport> : traits<SparseMatrix<double>> {};
} // namespace Eigen::internal

namespace pointgi {

struct Transport : Eigen::EigenBase<Transport> {
  using Scalar = double;
  using RealScalar = double;
  using StorageIndex = int;
  // NOLINTNEXTLINE(readability-identifier-naming): as Eigen calls them
  enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic, IsRowMajor = false };

  RadiosityOperator* exchange = nullptr;
  View<float> albedo = {};
  mutable std::vector<double> irradiance = {};
  mutable unsigned applies = 0;

  Eigen::Index rows() const { return static_cast<Eigen::Index>(albedo.size); }
  Eigen::Index cols() const { return rows(); }
  template <class Right>
  Eigen::Product<Transport, Right, Eigen::AliasFreeProduct> operator*(const Eigen::MatrixBase<Right>& x) const {
    return {*this, x.derived()};
  }
};

} // namespace pointgi

namespace Eigen::internal {
template <class Right>
struct generic_product_impl<pointgi::Transport, Right, SparseShape, DenseShape, GemvProduct>
    : generic_product_impl_base<pointgi::Transport, Right, generic_product_impl<pointgi::Transport, Right>> {
  template <class Result> // NOLINTNEXTLINE(readability-identifier-naming): as Eigen calls it
  static void scaleAndAddTo(Result& result, const pointgi::Transport& transport, const Right& x, const double& scale) {
    const Ref<const VectorXd> b = x; // copied only where it is an expression
    ++transport.applies;
    transport.exchange->apply({b.data(), static_cast<std::size_t>(b.size())}, pointgi::LinearisationPoint::kept,
                              transport.irradiance);
    const Map<const VectorXd> h(transport.irradiance.data(), b.size());
    const Map<const VectorXf> albedo(transport.albedo.data, b.size());
    result += scale * (b - albedo.cast<double>().cwiseProduct(h));
  }
};
} // namespace Eigen::internal

namespace pointgi {

KrylovResult solve_krylov(RadiosityOperator& exchange, View<float> emission, View<float> albedo, double tolerance,
                          unsigned most_steps, std::vector<double>& x) {
  Transport transport;
  transport.exchange = &exchange;
  transport.albedo = albedo;
  const Eigen::VectorXd emitted = Eigen::Map<const Eigen::VectorXf>(emission.data, transport.rows()).cast<double>();
  Eigen::Map<Eigen::VectorXd> guess(x.data(), transport.rows());
  Eigen::BiCGSTAB<Transport, Eigen::IdentityPreconditioner> solver;
  solver.compute(transport);
  solver.setTolerance(tolerance);
  solver.setMaxIterations(static_cast<Eigen::Index>(most_steps));
  const double before = (emitted - transport * guess).norm();
  const Eigen::VectorXd found = solver.solveWithGuess(emitted, guess);
  KrylovResult result;
  result.steps = static_cast<unsigned>(solver.iterations());
  result.applies = transport.applies;
  // Its own residual is a recurrence; NaN after a breakdown.
  result.useful = found.allFinite() && solver.error() * emitted.norm() < before;
  if (result.useful) guess = found;
  return result;
}

} // namespace pointgi
