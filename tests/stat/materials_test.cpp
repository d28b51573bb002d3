/// Directions in which surfaces scatter rays, against densities written here.
#include "tests/stat/samplers.h"
#include "tests/support/fresnel.h"

using namespace pointgi;
using namespace pointgi::test;

namespace {

constexpr std::size_t samples = 50'000;

/// One ray that a surface has scattered.
struct Scattered {
  Vector3d direction;
  bool goes_on;
  double weight, pdf, f, pdf_of_eval;
};

std::vector<Scattered> scatter(const Material& material, const cl_float4& normal, const cl_float4& direction) {
  const auto materials = session().upload(std::vector<Material>{material});
  const auto drawn = draw("probe_scatter", samples, 3, 6, materials, normal, direction);
  std::vector<Scattered> rays;
  for (std::size_t i = 0; i < drawn.size(); i += 3)
    rays.push_back({vector_of(drawn[i]), drawn[i].s[3] > 0.0f, drawn[i + 1].s[1], drawn[i + 1].s[3], drawn[i + 2].s[1],
                    drawn[i + 2].s[3]});
  return rays;
}

Material material_of(MaterialKindNumber type, pg_uint flags) {
  Material material{};
  material.type = type;
  material.flags = MATERIAL_SPECULAR | flags;
  for (float& c : material.specular)
    c = 1.0f;
  return material;
}

/// The surface that all these rays meet, and a ray that meets it at that angle; as the device has them.
const Vector3d normal = vector_of(float4_of(Vector3d(0.36, -0.48, 0.8)));

cl_float4 ray_at(double degrees) {
  const Vector3d along = normal.unitOrthogonal();
  return float4_of(std::sin(degrees * pi / 180.0) * along - std::cos(degrees * pi / 180.0) * normal);
}

/// GGX by Walter et al. (2007), of the tangents of angles with the mean normal.
struct Ggx {
  double alpha;

  double density(double tangent2) const { // of normals, per solid angle
    const double cosine2 = 1.0 / (1.0 + tangent2), t = 1.0 + tangent2 / (alpha * alpha);
    return 1.0 / (pi * alpha * alpha * cosine2 * cosine2 * t * t);
  }
  double masking(double cosine) const {
    return 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * (1.0 / (cosine * cosine) - 1.0)));
  }
  /// Smith's masking of one direction and shadowing of another, correlated by height.
  double both(double cosine, double other) const { return 1.0 / (1.0 / masking(cosine) + 1.0 / masking(other) - 1.0); }
};

/// Masses of mirrored directions on `bins`, and below the surface on one bin more: the density of visible normals, G1 D
/// (v.h) / (v.n), over normals that lie as D cos does: tangent^2 = alpha^2 u / (1 - u), and 1 - u = (1 - s)^2, lest
/// flat normals, which are rare but tall, be missed.
std::vector<double> masses_of_visible_normals(const Ggx& ggx, const Vector3d& v, const PolarBins& bins) {
  constexpr int rings = 1000, sectors = 400;
  std::vector<double> masses(bins.size() + 1);
  const Vector3d a = normal.unitOrthogonal(), b = normal.cross(a);
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      // Steps of each sector begin elsewhere, by the golden ratio: together they are as fine as a bin's edges need.
      const double s = (i + std::fmod(0.6180339887498949 * (j + 0.5), 1.0)) / rings, rest = (1.0 - s) * (1.0 - s);
      const double tangent = ggx.alpha * std::sqrt((1.0 - rest) / rest), cosine = 1.0 / std::hypot(1.0, tangent);
      const double turn = 2.0 * pi * (j + 0.5) / sectors;
      const Vector3d h = cosine * (normal + tangent * (std::cos(turn) * a + std::sin(turn) * b));
      const double visible = v.dot(h);
      if (visible <= 0.0) continue;
      const Vector3d l = 2.0 * visible * h - v;
      const double mass = ggx.masking(v.dot(normal)) * visible / (v.dot(normal) * cosine) * 2.0 * (1.0 - s);
      masses[l.dot(normal) > 0.0 ? bins.of(l) : bins.size()] += mass / (rings * sectors);
    }
  return masses;
}

} // namespace

TEST_CASE("rough metal scatters by the normals that are visible") {
  const double alpha = GENERATE(0.01, 0.1, 0.5, 1.0), degrees = GENERATE(0.0, 30.0, 60.0, 80.0, 89.0);
  CAPTURE(alpha, degrees);
  Material material = material_of(MATERIAL_CONDUCTOR, MATERIAL_HAS_LOBE);
  material.alpha = static_cast<float>(alpha);
  const cl_float4 ray = ray_at(degrees);
  const Vector3d v = -vector_of(ray).normalized(), n = normal.normalized();
  const double to_viewer = v.dot(n);
  const Ggx ggx{static_cast<double>(material.alpha)};
  const PolarBins bins(2.0 * to_viewer * n - v, log_edges(0.01 * alpha * alpha, 2.0, 24), 8);
  const std::vector<double> masses = masses_of_visible_normals(ggx, v, bins);
  double total = 0.0;
  for (const double mass : masses)
    total += mass;
  CHECK(total == Approx(1.0).epsilon(1e-3)); // a theorem of Smith's masking, and a test of the quadrature
  std::vector<double> counts(masses.size());
  double off_pdf = 0.0, off_eval = 0.0, off_weight = 0.0, off_f = 0.0;
  for (const Scattered& ray_out : scatter(material, float4_of(normal, 1.0), ray)) {
    const Vector3d l = ray_out.direction;
    const double to_light = l.dot(n);
    counts[ray_out.goes_on ? bins.of(l) : bins.size()] += 1.0;
    if (to_light < 1e-3) continue; // where the float of the cosine is short of digits
    const Vector3d h = (v + l).normalized();
    const double density = ggx.density(h.cross(n).squaredNorm() / std::pow(h.dot(n), 2));
    const double pdf = density * ggx.masking(to_viewer) / (4.0 * to_viewer);
    const double weight = ggx.both(to_viewer, to_light) / ggx.masking(to_viewer);
    const auto off = [](double value, double truth) { return std::fabs(value / truth - 1.0); };
    off_pdf = std::fmax(off_pdf, off(ray_out.pdf, pdf));
    off_eval = std::fmax(off_eval, off(ray_out.pdf_of_eval, pdf));
    off_weight = std::fmax(off_weight, off(ray_out.weight, weight));
    off_f = std::fmax(off_f, off(ray_out.f * to_light, weight * pdf));
  }
  check_fit(counts, masses);
  // A direction is rounded by 1e-7, the half-vector by that over twice the viewer's cosine (for light against it), and
  // the density goes at most as the fourth power of the angle in units of alpha.
  const double rounding = 1e-3 + 4.0 * 2e-7 / (to_viewer * alpha);
  CAPTURE(rounding);
  CHECK(off_pdf < rounding);
  CHECK(off_eval < rounding);
  CHECK(off_weight < 1e-3);
  CHECK(off_f < rounding);
}

TEST_CASE("a Phong surface scatters about the mirrored ray, and says with which density") {
  const double exponent = GENERATE(1.0, 50.0, 2000.0), degrees = GENERATE(0.0, 50.0, 85.0);
  CAPTURE(exponent, degrees);
  Material material = material_of(MATERIAL_PHONG, MATERIAL_HAS_LOBE);
  material.exponent = static_cast<float>(exponent);
  const cl_float4 ray = ray_at(degrees);
  const Vector3d d = vector_of(ray).normalized(), n = normal.normalized(), mirrored = d - 2.0 * d.dot(n) * n;
  const PolarBins bins(mirrored, log_edges(0.01 / (exponent + 1.0), 1.0, 20), 8);
  const auto density = [&](double height) {
    return (exponent + 1.0) / (2.0 * pi) * std::exp(exponent * std::log1p(-std::min(height, 1.0)));
  };
  std::vector<double> counts(bins.size());
  double off = 0.0;
  std::size_t wrong_end = 0;
  for (const Scattered& ray_out : scatter(material, float4_of(normal, 1.0), ray)) {
    counts[bins.of(ray_out.direction)] += 1.0;
    const double cosine = ray_out.direction.dot(n);
    wrong_end += std::fabs(cosine) > 1e-6 && ray_out.goes_on != (cosine > 0.0); // below the surface rays end
    const double truth = density(bins.height_of(ray_out.direction));
    if (truth > 1e-3 * exponent)
      off =
          std::fmax(off, std::fmax(std::fabs(ray_out.pdf / truth - 1.0), std::fabs(ray_out.pdf_of_eval / truth - 1.0)));
  }
  check_fit(counts, bins.masses(density));
  CHECK(wrong_end == 0);
  CHECK(off < 1e-4 + 3.0 * 1.2e-7 * exponent); // a rounded cosine to the power of the exponent; three vectors rounded
}

TEST_CASE("glass reflects as large a share of its rays as Fresnel says") {
  const bool from_outside = GENERATE(true, false);
  const double degrees = GENERATE(0.0, 30.0, 38.0, 60.0, 85.0);
  CAPTURE(from_outside, degrees);
  Material material = material_of(MATERIAL_GLASS, MATERIAL_TRANSMITS);
  material.ior = 1.5f;
  const cl_float4 ray = ray_at(degrees);
  const Vector3d d = vector_of(ray), front = from_outside ? normal : -normal;
  std::vector<double> counts(2);
  std::size_t lost = 0;
  for (const Scattered& ray_out : scatter(material, float4_of(front, from_outside ? 1.0 : -1.0), ray)) {
    lost += !ray_out.goes_on || ray_out.weight != 1.0;
    counts[ray_out.direction.dot(normal) > 0.0 ? 1 : 0] += 1.0;
  }
  CHECK(lost == 0);
  REQUIRE(d.dot(normal) < 0.0);
  const double reflected = fresnel(degrees, from_outside ? 1.5 : 1.0 / 1.5);
  if (reflected < 1.0)
    check_fit(counts, {1.0 - reflected, reflected});
  else
    CHECK(counts[0] == 0.0);
}
