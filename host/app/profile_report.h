#pragma once
/// What `pointgi profile` tells: a table for people, the same in Markdown, everything in JSON.
#include "host/cl/device.h"
#include "host/stages/stages.h"
#include "host/tune/profile.h"
#include <nlohmann/json.hpp>

namespace pointgi {

struct ProfileReport {
  ProfileReport(const DeviceInfo& d, const Profile& p) : device(d), profile(p) {}

  const DeviceInfo& device;
  const Profile& profile;
  std::string scene;  ///< as the user named it
  std::string filter; ///< as the user gave it
  std::size_t splats = 0;
  int rounds = 0;
  unsigned seed = 1;
  std::vector<TraversalVariant> invalid; ///< not measured: a precondition is broken
  std::string stored;                    ///< where the winner was stored; empty: it was not
  std::string not_stored;                ///< why not
};

/// Fastest first, then what is wrong or could not be measured.
std::string profile_table(const ProfileReport& report);
std::string profile_markdown(const ProfileReport& report);
nlohmann::json profile_json(const ProfileReport& report, const StageLog& stages);

/// Every variant, what it needs, and whether the device has it.
std::string variant_listing(const std::vector<TraversalVariant>& variants, const DeviceInfo& device);

} // namespace pointgi
