#include "host/radiosity/fmm.h"
#include "host/radiosity/block_launches.h"
#include "host/radiosity/point_planes.h"
#include <algorithm>
#include <stdexcept>

namespace pointgi {

namespace {

std::vector<FmmCluster> device_clusters(const ClusterTree& tree) {
  std::vector<FmmCluster> clusters;
  clusters.reserve(tree.nodes.size());
  for (const Cluster& c : tree.nodes)
    clusters.push_back({c.first_point, c.count, c.first_child, c.child_count, c.parent});
  return clusters;
}

std::vector<FmmGrid> device_grids(const Grids& grids) {
  std::vector<FmmGrid> device;
  device.reserve(grids.of.size());
  for (const Grid& g : grids.of) {
    FmmGrid d{};
    for (int a = 0; a < 3; ++a) {
      d.centre[a] = static_cast<float>(g.centre[a]);
      d.half_side[a] = static_cast<float>(g.half_side[a]);
    }
    d.axis = g.axis[0] | g.axis[1] << 8 | g.axis[2] << 16;
    d.first = g.first;
    device.push_back(d);
  }
  return device;
}

} // namespace

DeviceFmm::Rows DeviceFmm::upload(const SourceLists& lists) {
  return {session_.upload(lists.begin), session_.upload(lists.source), session_.upload(lists.share),
          session_.upload(lists.own_share)};
}

DeviceFmm::Jobs DeviceFmm::make_jobs(const std::vector<cl_uint4>& items, const std::vector<double>& costs) {
  Jobs jobs;
  jobs.pace = pace_of_blocks(session_, first_pairs);
  jobs.items = session_.upload(items);
  jobs.cost.assign(1, 0.0);
  for (const double cost : costs)
    jobs.cost.push_back(jobs.cost.back() + cost);
  return jobs;
}

/// Jobs of blocks of nodes: of leaves from their points, level by level up and down, and of all from their far sources.
void DeviceFmm::make_node_jobs() {
  struct List {
    std::vector<cl_uint4> items;
    std::vector<double> costs;
    void add(cl_uint cluster, cl_uint node, double cost) {
      items.push_back({{cluster, node, 0, 0}});
      costs.push_back(cost);
    }
  };
  std::vector<List> up, down;
  List leaves, far;
  for (cl_uint k = 0; k < tree_.nodes.size(); ++k) {
    const Cluster& cluster = tree_.nodes[k];
    const Grid& grid = grids_.of[k];
    if (cluster.level >= up.size()) {
      up.resize(cluster.level + 1);
      down.resize(cluster.level + 1);
    }
    double children = 0.0, sources = 1.0;
    for (cl_uint c = cluster.first_child; c < cluster.first_child + cluster.child_count; ++c)
      children += grids_.of[c].count;
    for (cl_uint e = lists_.far.begin[k]; e < lists_.far.begin[k + 1]; ++e)
      sources += grids_.of[lists_.far.source[e]].count;
    for (cl_uint node = grid.first; node < grid.first + grid.count; node += FMM_LANES) {
      if (cluster.child_count == 0)
        leaves.add(k, node, cluster.count);
      else
        up[cluster.level].add(k, node, children);
      if (k != 0) down[cluster.level].add(k, node, grids_.of[cluster.parent].count);
      far.add(k, node, sources);
    }
  }
  for (const List& level : up)
    up_.push_back(make_jobs(level.items, level.costs));
  for (const List& level : down)
    down_.push_back(make_jobs(level.items, level.costs));
  leaves_ = make_jobs(leaves.items, leaves.costs);
  far_ = make_jobs(far.items, far.costs);
}

/// Jobs of blocks of a leaf's points: what they interpolate, and what they read of the rows of the leaf and all above.
void DeviceFmm::make_point_jobs() {
  std::vector<double> reads(tree_.nodes.size());
  std::vector<cl_uint4> items;
  std::vector<double> costs, nodes;
  for (cl_uint k = 0; k < tree_.nodes.size(); ++k) {
    const Cluster& cluster = tree_.nodes[k];
    reads[k] = k == 0 ? 1.0 : reads[cluster.parent];
    for (cl_uint e = lists_.mid.begin[k]; e < lists_.mid.begin[k + 1]; ++e)
      reads[k] += sides_.begin[lists_.mid.source[e] + 1] - sides_.begin[lists_.mid.source[e]];
    for (cl_uint e = lists_.near_.begin[k]; e < lists_.near_.begin[k + 1]; ++e)
      reads[k] += tree_.nodes[lists_.near_.source[e]].count;
    if (cluster.child_count != 0) continue;
    for (cl_uint i = 0; i < cluster.count; i += FMM_LANES) {
      items.push_back({{k, cluster.first_point + i, std::min<cl_uint>(FMM_LANES, cluster.count - i), 0}});
      costs.push_back(reads[k]);
      nodes.push_back(grids_.of[k].count);
    }
  }
  read_ = make_jobs(items, costs);
  interpolate_ = make_jobs(items, nodes);
}

DeviceFmm::DeviceFmm(Session& session, const ClusterTree& tree, View<Link> links, const FmmOptions& options,
                     View<std::uint8_t> point_shares)
    : session_(session), tree_(tree), grids_(make_grids(tree, options.grid)),
      lists_(make_interaction_lists(tree, links, point_shares.size, grids_, options.lists)),
      points_(tree.points.begin(), tree.points.end()), sides_(flux_sides(tree)),
      nodes_(static_cast<cl_uint>(grids_.nodes())), stride_(plane_stride(points_.size())),
      group_(session.info().is_cpu ? 8 : 32) {
  make_node_jobs();
  make_point_jobs();
  far_rows_ = upload(lists_.far);
  mid_rows_ = upload(lists_.mid);
  near_rows_ = upload(lists_.near_);
  std::vector<cl_uchar> shares(point_shares.size + FMM_LANES); // blocks read past the last point
  std::copy(point_shares.begin(), point_shares.end(), shares.begin());
  point_shares_ = session_.upload(shares);
  flux_begin_ = session_.upload(sides_.begin);
  cluster_buffer_ = session_.upload(device_clusters(tree));
  grid_buffer_ = session_.upload(device_grids(grids_));
  std::vector<cl_float> positions;
  for (const auto& axis : grids_.position)
    positions.insert(positions.end(), axis.begin(), axis.end());
  node_buffer_ = session_.upload(positions);
  point_buffer_ = session_.upload(point_planes(points_, stride_));
  moments_ = session_.allocate<cl_float>(FMM_VALUES * static_cast<std::size_t>(nodes_));
  local_ = session_.allocate<cl_float>(FMM_VALUES * static_cast<std::size_t>(nodes_));
  irradiance_ = session_.allocate<cl_float>(3 * static_cast<std::size_t>(stride_));
  const auto kernel = [&](const char* file, const char* name) {
    const Program program = fmm_program(file, fmm_lanes_on(session_.info()));
    return session_.kernel(program.file, program.options, name);
  };
  p2m_ = kernel("radiosity/fmm/expand.cl", "p2m");
  m2m_ = kernel("radiosity/fmm/expand.cl", "m2m");
  l2l_ = kernel("radiosity/fmm/expand.cl", "l2l");
  l2p_ = kernel("radiosity/fmm/expand.cl", "l2p");
  m2l_ = kernel("radiosity/fmm/m2l.cl", "m2l");
  receive_points_ = kernel("radiosity/fmm/near.cl", "receive_points");
}

template <class Launch>
void DeviceFmm::in_pieces(Jobs& jobs, const Launch& launch) {
  for_each_batch(WeighedItems{jobs.cost}, jobs.pace, {}, [&](std::size_t first, std::size_t count) {
    const double seconds =
        launch(line_of_blocks(session_, count, group_), static_cast<cl_uint>(first), static_cast<cl_uint>(count));
    device_seconds_ += seconds;
    return seconds;
  });
}

namespace {

FmmFlux device_flux(const ClusterFlux& f) {
  FmmFlux d{};
  for (int a = 0; a < 3; ++a) {
    d.centre[a] = static_cast<float>(f.centre[a]);
    for (int c = 0; c < 3; ++c) {
      d.flux[3 * c + a] = static_cast<float>(f.flux[c][a]);
      d.linearisation[3 * c + a] = static_cast<float>(f.linearisation[c][a]);
    }
  }
  return d;
}

} // namespace

void DeviceFmm::apply(View<double> radiosity, LinearisationPoint about, std::vector<double>& irradiance) {
  const auto flux = session_.upload(flux_planes(radiosity, points_, stride_));
  if (about == LinearisationPoint::kept && !has_linearisation_)
    throw std::invalid_argument("no linearisation point is kept");
  has_linearisation_ = true;
  update_cluster_fluxes(tree_, sides_, points_, radiosity, about, fluxes_);
  std::vector<FmmFlux> cluster_planes(fluxes_.size());
  std::transform(fluxes_.begin(), fluxes_.end(), cluster_planes.begin(), device_flux);
  const auto fluxes = session_.upload(cluster_planes);

  in_pieces(leaves_, [&](const LaunchShape& shape, cl_uint first, cl_uint count) {
    return session_.launch(p2m_, shape, leaves_.items, first, count, cluster_buffer_, grid_buffer_, nodes_,
                           point_buffer_, stride_, flux, moments_);
  });
  for (std::size_t level = up_.size(); level-- > 0;)
    in_pieces(up_[level], [&](const LaunchShape& shape, cl_uint first, cl_uint count) {
      return session_.launch(m2m_, shape, up_[level].items, first, count, cluster_buffer_, grid_buffer_, node_buffer_,
                             nodes_, moments_);
    });
  in_pieces(far_, [&](const LaunchShape& shape, cl_uint first, cl_uint count) {
    return session_.launch(m2l_, shape, far_.items, first, count, grid_buffer_, node_buffer_, nodes_, far_rows_.begin,
                           far_rows_.source, far_rows_.share, moments_, local_);
  });
  for (Jobs& level : down_)
    in_pieces(level, [&](const LaunchShape& shape, cl_uint first, cl_uint count) {
      return session_.launch(l2l_, shape, level.items, first, count, cluster_buffer_, grid_buffer_, node_buffer_,
                             nodes_, local_);
    });
  in_pieces(interpolate_, [&](const LaunchShape& shape, cl_uint first, cl_uint count) {
    return session_.launch(l2p_, shape, interpolate_.items, first, count, grid_buffer_, nodes_, point_buffer_, stride_,
                           local_, irradiance_);
  });
  in_pieces(read_, [&](const LaunchShape& shape, cl_uint first, cl_uint count) {
    return session_.launch(receive_points_, shape, read_.items, first, count, cluster_buffer_, point_buffer_, stride_,
                           flux, fluxes, flux_begin_, mid_rows_.begin, mid_rows_.source, mid_rows_.share,
                           mid_rows_.own_share, near_rows_.begin, near_rows_.source, near_rows_.share,
                           near_rows_.own_share, point_shares_, irradiance_);
  });

  irradiance = rows_of_planes(session_.download(irradiance_, irradiance_.size), points_.size(), stride_);
}

} // namespace pointgi
