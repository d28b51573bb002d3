#include "host/radiosity/voxel_pyramid.h"
#include "host/error.h"
#include "host/passes/variant.h"
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace pointgi {

namespace {

constexpr std::size_t group = 64;
/// Items of a first launch, of which nothing is known yet.
constexpr double first_items = 20000;
/// Empty voxels on each side: samples between a border's voxels and these are whole.
constexpr double spare = 1.5;
/// As OCTAGON_REACH of kernels/radiosity/cones/voxelise.cl, and a rounding.
constexpr double disc_reach = 1.054;

unsigned log2_of(unsigned side) {
  unsigned log2 = 0;
  while ((1u << log2) < side)
    ++log2;
  return log2;
}

} // namespace

ConeGrid cone_grid(View<Splat> points, unsigned side) {
  if (side < 8 || side > 256 || (side & (side - 1)) != 0)
    throw std::invalid_argument("voxels: a side is a power of two from 8 to 256");
  if (points.size == 0) throw std::invalid_argument("voxels: no points");
  double extent = 0.0, low[3];
  for (int a = 0; a < 3; ++a) {
    double high = -std::numeric_limits<double>::infinity();
    low[a] = -high;
    for (const Splat& s : points) {
      const double reach = disc_reach * s.radius * std::sqrt(std::max(0.0, 1.0 - double{s.normal[a]} * s.normal[a]));
      low[a] = std::min(low[a], s.position[a] - reach);
      high = std::max(high, s.position[a] + reach);
    }
    extent = std::max(extent, high - low[a]);
  }
  ConeGrid grid{};
  const double voxel = extent / (side - 2.0 * spare);
  grid.voxel = static_cast<float>(voxel);
  for (int a = 0; a < 3; ++a)
    grid.origin[a] = static_cast<float>(low[a] - spare * voxel);
  grid.side_log2 = log2_of(side);
  pg_uint first = 0;
  for (pg_uint level = 0; level < CONE_GRID_LEVELS(&grid); ++level) {
    const pg_uint row = (side >> level) + 2u;
    grid.first[level] = first;
    first += row * row * row;
  }
  return grid;
}

VoxelPyramid::VoxelPyramid(Session& session, View<Splat> points, const VoxelOptions& options)
    : session_(session), grid_(cone_grid(points, options.side)), texels_(texels_of(options.anisotropic)),
      grid_buffer_(session.upload(&grid_, 1)), points_(session.upload(points.data, points.size)),
      injections_(first_items, busy_work_items(session.info())),
      averages_(first_items, busy_work_items(session.info())) {
  const Program program = cones_program("radiosity/cones/pyramid.cl", texels_);
  inject_ = session.kernel(program.file, program.options, "inject_light");
  average_ = session.kernel(program.file, program.options, "average_children");
  allocate_voxels();
  std::vector<cl_uint> begin;
  const std::vector<VoxelShare> shares = voxelise(begin);
  sort_shares(shares, begin);
}

void VoxelPyramid::allocate_voxels() {
  const pg_uint coarsest = CONE_GRID_LEVELS(&grid_) - 1u;
  const std::uint64_t texels = std::uint64_t{texels_} * (grid_.first[coarsest] + 27u);
  const std::uint64_t bytes = texels * sizeof(cl_float4), most = session_.info().max_allocation_bytes;
  if (bytes > most)
    throw Error(ErrorKind::memory, session_.info().name +
                                       ": radiosity.voxels = " + std::to_string(1u << grid_.side_log2) + " takes " +
                                       megabytes(bytes) + ", and the device gives " + megabytes(most) +
                                       " in one piece; use fewer voxels, anisotropic = false, or another --device");
  voxels_ = session_.allocate<cl_float4>(texels);
  session_.fill(voxels_, cl_float4{}, texels);
}

std::vector<VoxelShare> VoxelPyramid::voxelise(std::vector<cl_uint>& begin) {
  const Program program = cones_program("radiosity/cones/voxelise.cl");
  cl::Kernel count = session_.kernel(program.file, program.options, "count_shares"),
             write = session_.kernel(program.file, program.options, "write_shares");
  const std::size_t points = points_.size;
  const auto counts = session_.allocate<cl_uint>(points);
  Pace pace(first_items, busy_work_items(session_.info()));
  for_each_batch(EqualItems{points}, pace, {}, [&](std::size_t first, std::size_t size) {
    return session_.launch(count, LaunchShape::line(size, group), points_, static_cast<cl_uint>(first),
                           static_cast<cl_uint>(first + size), grid_buffer_, counts);
  });
  begin.assign(1, 0u);
  std::uint64_t all = 0;
  for (const cl_uint of_splat : session_.download(counts, points)) {
    all += of_splat;
    if (all > std::numeric_limits<cl_uint>::max())
      throw Error(ErrorKind::memory, "radiosity.method = \"cones\": the splats overlap more than 4294967295 voxels; "
                                     "use fewer radiosity.voxels, or smaller splats");
    begin.push_back(static_cast<cl_uint>(all));
  }
  std::vector<VoxelShare> shares(all);
  const auto begins = session_.upload(begin);
  for_each_batch(EqualItems{points}, pace, {}, [&](std::size_t first, std::size_t size) {
    const std::size_t written = begin[first + size] - begin[first];
    const auto some = session_.allocate<VoxelShare>(std::max<std::size_t>(1, written));
    const double seconds = session_.launch(write, LaunchShape::line(size, group), points_, static_cast<cl_uint>(first),
                                           static_cast<cl_uint>(first + size), grid_buffer_, begins, some);
    const std::vector<VoxelShare> found = session_.download(some, written);
    std::copy(found.begin(), found.end(), shares.begin() + begin[first]);
    return seconds;
  });
  return shares;
}

void VoxelPyramid::sort_shares(const std::vector<VoxelShare>& shares, const std::vector<cl_uint>& begin) {
  std::vector<cl_uint> splat(shares.size()), order(shares.size());
  for (std::size_t i = 0; i + 1 < begin.size(); ++i)
    std::fill(splat.begin() + begin[i], splat.begin() + begin[i + 1], static_cast<cl_uint>(i));
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](cl_uint a, cl_uint b) { return shares[a].voxel < shares[b].voxel; });
  std::vector<cl_uint> occupied, starts, splats;
  std::vector<cl_float> areas;
  for (const cl_uint k : order) {
    if (occupied.empty() || occupied.back() != shares[k].voxel) {
      occupied.push_back(shares[k].voxel);
      starts.push_back(static_cast<cl_uint>(splats.size()));
    }
    splats.push_back(splat[k]);
    areas.push_back(shares[k].area);
  }
  starts.push_back(static_cast<cl_uint>(splats.size()));
  begin_ = session_.upload(starts);
  splats_ = session_.upload(splats);
  areas_ = session_.upload(areas);
  make_levels(std::move(occupied));
}

void VoxelPyramid::make_levels(std::vector<cl_uint> occupied) {
  std::vector<cl_uchar> cells(voxels_.size / texels_);
  for (pg_uint level = 0;; ++level) {
    levels_.push_back(session_.upload(occupied));
    const pg_uint log2 = grid_.side_log2 - level, mask = (1u << log2) - 1u, row = mask + 3u;
    for (cl_uint& number : occupied) {
      const pg_uint x = number & mask, y = number >> log2 & mask, z = number >> 2 * log2;
      for (pg_uint k = 0; k < 8; ++k) // this is the (k + 1)-th of the eight of a sample
        cells[grid_.first[level] + ((z + 1 - (k >> 2)) * row + y + 1 - (k >> 1 & 1u)) * row + x + 1 - (k & 1u)] = 1;
      if (log2 > 0) number = ((z >> 1 << (log2 - 1) | y >> 1) << (log2 - 1)) | x >> 1;
    }
    if (log2 == 0) break;
    std::sort(occupied.begin(), occupied.end());
    occupied.erase(std::unique(occupied.begin(), occupied.end()), occupied.end());
  }
  cells_ = session_.upload(cells);
}

void VoxelPyramid::inject(View<cl_float4> radiosity) {
  if (radiosity.size != points_.size) throw std::invalid_argument("voxels: a radiosity a point");
  const auto light = session_.upload(radiosity.data, radiosity.size);
  for_each_batch(EqualItems{occupied()}, injections_, {}, [&](std::size_t first, std::size_t count) {
    return session_.launch(inject_, LaunchShape::line(count, group), levels_.front(), static_cast<cl_uint>(first),
                           static_cast<cl_uint>(first + count), grid_buffer_, begin_, splats_, areas_, points_, light,
                           voxels_);
  });
  for (cl_uint level = 1; level < levels_.size(); ++level)
    for_each_batch(EqualItems{levels_[level].size}, averages_, {}, [&](std::size_t first, std::size_t count) {
      return session_.launch(average_, LaunchShape::line(count, group), levels_[level], static_cast<cl_uint>(first),
                             static_cast<cl_uint>(first + count), grid_buffer_, level, voxels_);
    });
}

} // namespace pointgi
