#include "host/tune/profile.h"
#include "host/error.h"
#include "host/repeats.h"
#include "host/tune/profile_bench.h"
#include <algorithm>
#include <map>

namespace pointgi {

const char* name_of(ProfiledKernel kernel) {
  static constexpr const char* names[profiled_kernels] = {"eye", "bounced", "any", "segments", "photons", "render"};
  return names[static_cast<std::size_t>(kernel)];
}

bool VariantProfile::complete() const {
  return failure.empty() && std::all_of(kernels.begin(), kernels.end(),
                                        [](const KernelProfile& k) { return k.skipped || !k.seconds.empty(); });
}

bool VariantProfile::wrong() const {
  return !variant.fast_math &&
         std::any_of(kernels.begin(), kernels.end(), [](const KernelProfile& k) { return k.wrong > 0; });
}

double VariantProfile::speedup(ProfiledKernel kernel) const {
  return median_of_repeats(kernels[static_cast<std::size_t>(kernel)].speedup);
}

std::vector<std::size_t> Profile::ranking() const {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < variants.size(); ++i)
    if (variants[i].complete() && !variants[i].wrong()) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return variants[a].speedup() > variants[b].speedup(); });
  return order;
}

const VariantProfile* Profile::winner() const {
  for (const std::size_t i : ranking())
    if (!variants[i].variant.fast_math) return &variants[i];
  return nullptr;
}

namespace {

/// The reference is timed anew after so much of the device's time, and whenever the kernel changes: other work on the
/// machine comes and goes, and pairs that are close in time see the same of it.
constexpr double reference_interval = 0.15;

/// Launches are repeated in a round until they take half as long as the reference's: what a busy machine's scheduler
/// takes from a launch of milliseconds is all or nothing.
constexpr double repeated_share = 0.5;
constexpr int most_repeats = 16;

/// One launch that variants share when nothing in it differs between them.
struct Measured {
  ProfiledKernel kernel;
  TraversalVariant variant; ///< the first of them
  std::string pools;
  std::string failure;
  int repeats = 1; ///< launches a round
  KernelProfile times = {};
  std::uint64_t pool_bytes = 0;
};

/// Equal for launches that do the same work.
std::string launch_key(ProfiledKernel kernel, const TraversalVariant& v) {
  const bool picture = kernel == ProfiledKernel::render;
  // Photons go in work-groups of one size, whatever the variant's.
  if (kernel == ProfiledKernel::photons)
    return std::string(name_of(kernel)) + "|" + trace_photons_program(v, {}, PhotonStart::aimed).options + "|" +
           pools_key(v);
  const std::string options = picture ? eye_rays_program(v).options + shade_program(v, {}).options
                              : kernel == ProfiledKernel::segments ? segments_program(v).options
                                                                   : trace_program(v).options;
  const bool grouped = kernel == ProfiledKernel::eye || picture;
  return std::string(name_of(kernel)) + "|" + options + "|" + pools_key(v) + "|" +
         (picture ? name_of(v.group) : std::to_string(v.group.size())) + "|" + (grouped ? name_of(v.grouping) : "");
}

class Profiler {
public:
  Profiler(Session& session, const ProfileRequest& request, const std::function<void(double)>& progress,
           const std::function<bool()>& stop)
      : bench_(session, request), request_(request), progress_(progress), stop_(stop), reference_(reference_variant()) {
    reference_.max_depth = request_.scene.octree.max_depth;
    reference_.clips = !request_.clips.empty();
    reference_.patches = !request_.bends.empty();
  }

  Profile run() {
    reference_pools_ = bench_.load(reference_);
    bench_.take_reference(reference_, reference_pools_, profile_); // which also tells whether there are photons
    list_variants();
    for (std::size_t first = 0; first < groups_.size() && !profile_.interrupted;)
      first = run_batch(first);
    collect();
    return std::move(profile_);
  }

private:
  /// Variants whose pools are the same, by pools_key.
  struct Group {
    std::string key;
    TraversalVariant variant; ///< the first, for its pools
    std::vector<std::size_t> measured;
  };

  void list_variants() {
    std::vector<TraversalVariant> all{reference_};
    for (TraversalVariant v : request_.variants) {
      v.max_depth = reference_.max_depth;
      v.clips = reference_.clips;
      v.patches = reference_.patches;
      if (name_of(v) != name_of(reference_)) all.push_back(v);
    }
    std::map<std::string, std::size_t> launch_of, group_of;
    for (const TraversalVariant& v : all) {
      profile_.variants.push_back({});
      profile_.variants.back().variant = v;
      const std::string key = pools_key(v);
      const auto [group, is_new_group] = group_of.emplace(key, groups_.size());
      if (is_new_group) groups_.push_back({key, v, {}});
      launches_of_.emplace_back();
      for (std::size_t k = 0; k < profiled_kernels; ++k) {
        const auto kernel = static_cast<ProfiledKernel>(k);
        if (skips(kernel)) continue;
        const auto [at, is_new] = launch_of.emplace(launch_key(kernel, v), measured_.size());
        if (is_new) {
          measured_.push_back({kernel, v, key, {}, 1, {}});
          groups_[group->second].measured.push_back(at->second);
        }
        launches_of_.back()[k] = at->second;
      }
    }
    // Storages of one tree stand together, so that it is built once.
    std::stable_sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
      const auto rank = [](const Group& g) {
        return std::make_pair(g.variant.form == TraversalForm::wide, tree_key(g.variant));
      };
      return rank(a) < rank(b);
    });
  }

  /// As many groups from `first` on as the memory takes at a time; returns the first that is left.
  std::size_t run_batch(std::size_t first) {
    pools_.clear();
    std::vector<std::size_t> work;
    std::uint64_t bytes = 0;
    std::size_t end = first;
    for (; end < groups_.size() && (end == first || bytes < request_.pool_bytes); ++end) {
      const Group& group = groups_[end];
      if (stopped()) break;
      try {
        pools_[group.key] = bench_.load(group.variant);
        bytes += pools_[group.key].tree->bytes;
        work.insert(work.end(), group.measured.begin(), group.measured.end());
      } catch (const Error& error) {
        for (const std::size_t m : group.measured)
          fail(measured_[m], error);
      }
    }
    // A kernel's launches together, neighbours of the list one after another.
    std::sort(work.begin(), work.end(), [&](std::size_t a, std::size_t b) {
      return std::make_pair(measured_[a].kernel, a) < std::make_pair(measured_[b].kernel, b);
    });
    for (int round = 0; round <= request_.rounds && !profile_.interrupted; ++round)
      run_round(work, round);
    return end;
  }

  void run_round(const std::vector<std::size_t>& work, int round) {
    double since_reference = reference_interval;
    const std::size_t shift = work.empty() ? 0 : static_cast<std::size_t>(round) * work.size() / (request_.rounds + 1);
    for (std::size_t i = 0; i < work.size() && !stopped(); ++i) {
      Measured& m = measured_[work[(i + shift) % work.size()]];
      if (round > 0 && (since_reference >= reference_interval || m.kernel != reference_kernel_)) {
        reference_seconds_ = bench_.launch(m.kernel, reference_, reference_pools_);
        reference_kernel_ = m.kernel;
        since_reference = 0.0;
      }
      if (m.failure.empty()) since_reference += run_one(m, round);
      done_ += 1;
      progress_(static_cast<double>(done_) / (static_cast<double>(measured_.size()) * (request_.rounds + 1)));
    }
  }

  double run_one(Measured& m, int round) {
    const ProfiledPools& pools = pools_.at(m.pools);
    try {
      if (round == 0) {
        const Differences d = bench_.launch_and_compare(m.kernel, m.variant, pools);
        m.times.wrong = d.wrong;
        m.times.ties = d.ties;
        m.times.rays = bench_.rays(m.kernel);
        m.times.bytes = bench_.bytes(m.kernel, m.variant, pools);
        m.pool_bytes = pools.tree->bytes;
        const double once = std::max(bench_.launch(m.kernel, m.variant, pools), 1e-6);
        m.repeats = std::clamp(static_cast<int>(repeated_share * request_.launch_seconds / once), 1, most_repeats);
        return 0.0;
      }
      double total = 0.0;
      for (int k = 0; k < m.repeats; ++k)
        total += bench_.launch(m.kernel, m.variant, pools);
      const double seconds = total / m.repeats;
      m.times.seconds.push_back(seconds);
      m.times.speedup.push_back(is_reference(m) ? 1.0 : reference_seconds_ / std::max(seconds, 1e-9));
      return total;
    } catch (const Error& error) {
      fail(m, error);
      return 0.0;
    }
  }

  bool skips(ProfiledKernel kernel) const {
    return kernel == ProfiledKernel::photons && !profile_.without_photons.empty();
  }

  bool is_reference(const Measured& m) const { return name_of(m.variant) == name_of(reference_); }

  static void fail(Measured& m, const Error& error) {
    const std::string text = error.what();
    m.failure = text.substr(0, text.find('\n'));
  }

  bool stopped() {
    profile_.interrupted = profile_.interrupted || stop_();
    return profile_.interrupted;
  }

  void collect() {
    for (std::size_t i = 0; i < profile_.variants.size(); ++i) {
      VariantProfile& v = profile_.variants[i];
      for (std::size_t k = 0; k < profiled_kernels; ++k) {
        v.kernels[k].skipped = skips(static_cast<ProfiledKernel>(k));
        if (v.kernels[k].skipped) continue;
        const Measured& m = measured_[launches_of_[i][k]];
        v.kernels[k] = m.times;
        v.pool_bytes = std::max(v.pool_bytes, m.pool_bytes);
        if (v.failure.empty()) v.failure = m.failure;
      }
    }
  }

  ProfileBench bench_;
  const ProfileRequest& request_;
  const std::function<void(double)>& progress_;
  const std::function<bool()>& stop_;
  TraversalVariant reference_;
  ProfiledPools reference_pools_;
  ProfiledKernel reference_kernel_ =
      ProfiledKernel::eye; ///< the last one that the reference was timed on, and its time
  double reference_seconds_ = 0.0;
  std::vector<Measured> measured_;
  std::vector<Group> groups_;
  std::vector<std::array<std::size_t, profiled_kernels>>
      launches_of_; ///< of each variant: indices into measured_ of what is not skipped
  std::map<std::string, ProfiledPools> pools_;
  std::size_t done_ = 0;
  Profile profile_;
};

} // namespace

Profile profile_variants(Session& session, const ProfileRequest& request, const std::function<void(double)>& progress,
                         const std::function<bool()>& stop) {
  return Profiler(session, request, progress, stop).run();
}

} // namespace pointgi
