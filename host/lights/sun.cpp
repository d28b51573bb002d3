/// The sun with its sky: `date`, `time`, `latitude`, `longitude`, `north_deg`, `turbidity`, `ground_albedo`.
#include "host/lights/environment_map.h"
#include "host/lights/light_kind.h"
#include "host/lights/sky_model.h"
#include "host/lights/sun_position.h"
#include <cmath>
#include <fmt/format.h>

namespace pointgi {

namespace {

/// Rows of the sky's map: texels of a third of a degree, of which a picture of 60 degrees shows no steps.
constexpr int sky_height = 512;
constexpr limits::NumberRange turbidity_range{lowest_turbidity, highest_turbidity, false, false,
                                              "from 2 (very clear air) to 10 (thick haze)"};
constexpr double clear_air = 3.0, grass = 0.2;

/// A date is a text, or one of TOML's own, which stands without quotes.
std::string date_text(const TableReader& table) {
  const toml::node* node = table.find("date");
  const auto* date = node != nullptr ? node->as_date() : nullptr;
  if (date == nullptr) return table.need_text("date", date_words);
  return fmt::format("{:04d}-{:02d}-{:02d}", date->get().year, date->get().month, date->get().day);
}

DateTime time_of(const TableReader& table) {
  const auto date = parse_date(date_text(table));
  if (!date) table.fail("date", std::string("expected ") + date_words + ", found " + found_text(*table.find("date")));
  if (const toml::node* node = table.find("time"); node != nullptr && node->is_time())
    table.fail("time", std::string("expected ") + zoned_time_words + ", found a time without a zone");
  const auto time = parse_zoned_time(table.need_text("time", zoned_time_words));
  if (!time)
    table.fail("time", std::string("expected ") + zoned_time_words + ", found " + found_text(*table.find("time")));
  return {*date, time->time, time->zone};
}

void load(const TableReader& table, const LightContext& context, LightSettings& light) {
  const DateTime when = time_of(table);
  const double latitude = table.need_number("latitude", limits::latitude);
  const double longitude = table.need_number("longitude", limits::longitude);
  const double turbidity = table.number("turbidity", turbidity_range).value_or(clear_air);
  const double albedo = table.number("ground_albedo", limits::reflectance).value_or(grass);
  const SkyFrame frame = sky_frame(context.up, table.number("north_deg", limits::angle).value_or(0.0));
  const SunPosition sun = sun_position(when, latitude, longitude, Refraction::standard);
  const SkyModel model = make_sky_model(frame, sun.azimuth_deg, sun.elevation_deg, turbidity, albedo);
  if (model.is_night)
    context.warnings.push_back(light.place.text() +
                               fmt::format(": the sun is {:.1f} degrees below the horizon then, it gives no light; is "
                                           "the time's offset from UTC right?",
                                           -sun.elevation_deg));
  light.vector = model.towards_sun;
  light.strength = model.sun_irradiance;
  light.sine2 = std::pow(std::sin(0.5 * sun_diameter_deg * 3.14159265358979323846 / 180.0), 2);
  const int height = model.is_night ? 1 : sky_height; // black: one radiance
  light.sky = std::make_shared<const EnvironmentMap>(
      make_environment_map(sky_image(model, frame, 2 * height, height), frame, 1.0, "sky"));
}

} // namespace

extern const LightKind sun_kind;
const LightKind sun_kind{
    {"date", "time", "latitude", "longitude", "north_deg", "turbidity", "ground_albedo"}, load, true};

} // namespace pointgi
