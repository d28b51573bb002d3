#include "host/lights/sun_position.h"
#include "host/error.h"
#include <cmath>
#include <string>

namespace pointgi {

namespace {

constexpr double pi = 3.14159265358979323846;

double radians(double degrees) {
  return degrees * pi / 180.0;
}

double degrees(double radians) {
  return radians * 180.0 / pi;
}

/// Into [0, 360).
double turn(double degrees) {
  const double rest = std::fmod(degrees, 360.0);
  return rest < 0.0 ? rest + 360.0 : rest;
}

int days_in(int month, int year) {
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  if (month == 2) return leap ? 29 : 28;
  return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
}

/// Minutes since the local midnight.
double minutes_of(const ClockTime& time) {
  return 60.0 * time.hour + time.minute + time.second / 60.0;
}

/// Julian day of the date's midnight (Meeus, chapter 7).
double julian_day(const CalendarDate& date) {
  const int year = date.month > 2 ? date.year : date.year - 1, month = date.month > 2 ? date.month : date.month + 12;
  const int century = year / 100;
  return std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + date.day + 2 - century + century / 4 -
         1524.5;
}

/// A number of exactly `digits` digits at `at`, which moves behind it.
std::optional<int> take_number(std::string_view text, std::size_t& at, std::size_t digits) {
  if (at + digits > text.size()) return std::nullopt;
  int number = 0;
  for (const std::size_t end = at + digits; at < end; ++at) {
    if (text[at] < '0' || text[at] > '9') return std::nullopt;
    number = 10 * number + (text[at] - '0');
  }
  return number;
}

bool take(std::string_view text, std::size_t& at, char c) {
  if (at >= text.size() || text[at] != c) return false;
  ++at;
  return true;
}

/// [deg] that the sun of this true elevation is seen higher (NOAA; Meeus, chapter 16).
double standard_refraction(double elevation) {
  if (elevation > 85.0) return 0.0;
  const double t = std::tan(radians(elevation));
  double seconds = 0.0;
  if (elevation > 5.0)
    seconds = 58.1 / t - 0.07 / (t * t * t) + 0.000086 / std::pow(t, 5);
  else if (elevation > -0.575)
    seconds = 1735.0 + elevation * (-518.2 + elevation * (103.4 + elevation * (-12.79 + elevation * 0.711)));
  else
    seconds = -20.772 / t;
  return seconds / 3600.0;
}

/// What depends on the moment alone.
struct Sun {
  double declination;      ///< radians
  double equation_of_time; ///< minutes
};

Sun sun_at(double julian_century) {
  const double t = julian_century;
  const double longitude = turn(280.46646 + t * (36000.76983 + t * 0.0003032)); // mean
  const double anomaly = radians(357.52911 + t * (35999.05029 - 0.0001537 * t));
  const double eccentricity = 0.016708634 - t * (0.000042037 + 0.0000001267 * t);
  const double centre = std::sin(anomaly) * (1.914602 - t * (0.004817 + 0.000014 * t)) +
                        std::sin(2.0 * anomaly) * (0.019993 - 0.000101 * t) + std::sin(3.0 * anomaly) * 0.000289;
  const double node = radians(125.04 - 1934.136 * t);
  const double apparent_longitude = radians(longitude + centre - 0.00569 - 0.00478 * std::sin(node));
  const double mean_obliquity = 23.0 + (26.0 + (21.448 - t * (46.815 + t * (0.00059 - t * 0.001813))) / 60.0) / 60.0;
  const double obliquity = radians(mean_obliquity + 0.00256 * std::cos(node));
  const double y = std::pow(std::tan(0.5 * obliquity), 2), l = radians(longitude);
  const double hour_angle = y * std::sin(2.0 * l) - 2.0 * eccentricity * std::sin(anomaly) +
                            4.0 * eccentricity * y * std::sin(anomaly) * std::cos(2.0 * l) -
                            0.5 * y * y * std::sin(4.0 * l) -
                            1.25 * eccentricity * eccentricity * std::sin(2.0 * anomaly);
  return {std::asin(std::sin(obliquity) * std::sin(apparent_longitude)), 4.0 * degrees(hour_angle)};
}

void require(bool holds, const std::string& what) {
  if (!holds) throw Error(ErrorKind::input, "position of the sun: " + what);
}

void check(const DateTime& when, double latitude, double longitude) {
  require(is_valid(when.date), std::string("the date is none, expected ") + date_words + "; correct the date");
  require(is_valid(when.time),
          "the time is none, expected hours 0 to 23, minutes and seconds below 60; correct the time");
  require(std::abs(when.zone.minutes) <= 14 * 60,
          std::string("the time zone is none, expected ") + zone_words + "; correct the zone");
  require(std::fabs(latitude) <= 90.0,
          "latitude " + std::to_string(latitude) + ", expected degrees from -90 to 90; give north as positive");
  require(std::fabs(longitude) <= 180.0,
          "longitude " + std::to_string(longitude) + ", expected degrees from -180 to 180; give east as positive");
}

} // namespace

bool is_valid(const CalendarDate& date) {
  return date.year >= 1800 && date.year <= 2200 && date.month >= 1 && date.month <= 12 && date.day >= 1 &&
         date.day <= days_in(date.month, date.year);
}

bool is_valid(const ClockTime& time) {
  return time.hour >= 0 && time.hour < 24 && time.minute >= 0 && time.minute < 60 && time.second >= 0.0 &&
         time.second < 60.0;
}

std::optional<CalendarDate> parse_date(std::string_view text) {
  std::size_t at = 0;
  const auto year = take_number(text, at, 4);
  if (!year || !take(text, at, '-')) return std::nullopt;
  const auto month = take_number(text, at, 2);
  if (!month || !take(text, at, '-')) return std::nullopt;
  const auto day = take_number(text, at, 2);
  if (!day || at != text.size()) return std::nullopt;
  const CalendarDate date{*year, *month, *day};
  return is_valid(date) ? std::optional(date) : std::nullopt;
}

std::optional<TimeZone> parse_zone(std::string_view text) {
  if (text == "Z" || text == "z") return TimeZone{0};
  std::size_t at = 0;
  const bool west = take(text, at, '-');
  if (!west && !take(text, at, '+')) return std::nullopt;
  const auto hours = take_number(text, at, 2);
  if (!hours || !take(text, at, ':')) return std::nullopt;
  const auto minutes = take_number(text, at, 2);
  if (!minutes || at != text.size() || *minutes > 59 || 60 * *hours + *minutes > 14 * 60) return std::nullopt;
  return TimeZone{(west ? -1 : 1) * (60 * *hours + *minutes)};
}

std::optional<ClockTime> parse_clock(std::string_view text) {
  std::size_t at = 0;
  const auto hour = take_number(text, at, 2);
  if (!hour || !take(text, at, ':')) return std::nullopt;
  const auto minute = take_number(text, at, 2);
  if (!minute) return std::nullopt;
  ClockTime time{*hour, *minute, 0.0};
  if (take(text, at, ':')) {
    const auto second = take_number(text, at, 2);
    if (!second) return std::nullopt;
    time.second = *second;
    if (take(text, at, '.')) {
      double digit = 0.1;
      const std::size_t first = at;
      for (; at < text.size() && text[at] >= '0' && text[at] <= '9'; ++at, digit *= 0.1)
        time.second += digit * (text[at] - '0');
      if (at == first) return std::nullopt;
    }
  }
  return at == text.size() && is_valid(time) ? std::optional(time) : std::nullopt;
}

std::optional<ZonedTime> parse_zoned_time(std::string_view text) {
  const std::size_t split = text.find_first_of("+-Zz");
  if (split == std::string_view::npos) return std::nullopt;
  std::string_view clock = text.substr(0, split);
  if (!clock.empty() && clock.back() == ' ') clock.remove_suffix(1);
  const auto time = parse_clock(clock);
  const auto zone = parse_zone(text.substr(split));
  if (!time || !zone) return std::nullopt;
  return ZonedTime{*time, *zone};
}

SunPosition sun_position(const DateTime& when, double latitude_deg, double longitude_deg, Refraction refraction) {
  check(when, latitude_deg, longitude_deg);
  const double utc_minutes = minutes_of(when.time) - when.zone.minutes;
  const double century = (julian_day(when.date) + utc_minutes / 1440.0 - 2451545.0) / 36525.0;
  const Sun sun = sun_at(century);
  const double solar_minutes = utc_minutes + sun.equation_of_time + 4.0 * longitude_deg;
  const double hour_angle = radians(solar_minutes / 4.0 - 180.0), latitude = radians(latitude_deg);
  // As a vector: the arc cosines of the calculator lose half their digits near the meridian and the zenith.
  const double east = -std::cos(sun.declination) * std::sin(hour_angle);
  const double north = std::sin(sun.declination) * std::cos(latitude) -
                       std::cos(sun.declination) * std::cos(hour_angle) * std::sin(latitude);
  const double up = std::sin(sun.declination) * std::sin(latitude) +
                    std::cos(sun.declination) * std::cos(hour_angle) * std::cos(latitude);
  SunPosition position;
  position.azimuth_deg = turn(degrees(std::atan2(east, north)));
  position.elevation_deg = degrees(std::atan2(up, std::hypot(east, north)));
  if (refraction == Refraction::standard) position.elevation_deg += standard_refraction(position.elevation_deg);
  position.declination_deg = degrees(sun.declination);
  position.equation_of_time_min = sun.equation_of_time;
  return position;
}

} // namespace pointgi
