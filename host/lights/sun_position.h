#pragma once
/// Where the sun stands at a place and time, and the words for both in a scene file.
#include <optional>
#include <string_view>

namespace pointgi {

/// A moment by the clock of a place: Gregorian calendar, civil time.
struct CalendarDate {
  int year = 2000;
  int month = 1; ///< 1 to 12
  int day = 1;   ///< 1 to the month's last
};

struct ClockTime {
  int hour = 12;       ///< 0 to 23
  int minute = 0;      ///< 0 to 59
  double second = 0.0; ///< 0 to below 60; a leap second is none that the sun keeps
};

/// Minutes that the place's clock is ahead of UTC, from -14 h to +14 h: +330 for "+05:30".
struct TimeZone {
  int minutes = 0;
};

struct DateTime {
  CalendarDate date;
  ClockTime time;
  TimeZone zone;
};

/// What a scene's words must be, for errors.
inline constexpr const char* date_words = "a date of the calendar from 1800 to 2200 like \"2024-06-21\"";
inline constexpr const char* zone_words = "an offset from UTC like \"+05:30\", \"-07:00\" or \"Z\"";
inline constexpr const char* zoned_time_words = "a time with its offset from UTC like \"14:30+02:00\" or \"12:30:15Z\"";

/// Whether the day exists and lies in the years for which sun_position() is right, 1800 to 2200.
bool is_valid(const CalendarDate& date);
bool is_valid(const ClockTime& time);

/// "YYYY-MM-DD"; nothing where the text is no valid date.
std::optional<CalendarDate> parse_date(std::string_view text);
/// "+HH:MM", "-HH:MM", "Z" or "z"; nothing where the text is none of them or farther than 14 h from UTC.
std::optional<TimeZone> parse_zone(std::string_view text);
/// "HH:MM" or "HH:MM:SS" or "HH:MM:SS.sss".
std::optional<ClockTime> parse_clock(std::string_view text);

struct ZonedTime {
  ClockTime time;
  TimeZone zone;
};
/// A clock time and a zone, with or without a space between them.
std::optional<ZonedTime> parse_zoned_time(std::string_view text);

enum class Refraction {
  none,     ///< the direction in which the sun is
  standard, ///< the direction in which it is seen, through air of 1010 hPa and 10 °C
};

struct SunPosition {
  double azimuth_deg = 0.0;   ///< [0, 360) from north over east; at a pole, or in the zenith, any
  double elevation_deg = 0.0; ///< [-90, 90] above the horizon, of the disc's centre
  double declination_deg = 0.0;
  double equation_of_time_min = 0.0; ///< apparent less mean solar time
};

/// The sun as seen from `latitude_deg` [-90, 90], north positive, and `longitude_deg` [-180, 180], east positive, by
/// the formulas of NOAA's solar calculator (gml.noaa.gov/grad/solcalc/calcdetails.html), which are the low-precision
/// ones of Meeus, "Astronomical Algorithms", chapters 25 and 28; refraction as that calculator has it. Good to 0.02
/// degrees between the polar circles from 1800 to 2200: parallax (0.0024 degrees), the difference of terrestrial and
/// universal time (3e-5 degrees a minute) and the planets' pull are left out. Throws Error(input) for a date, time,
/// latitude or longitude outside those ranges.
SunPosition sun_position(const DateTime& when, double latitude_deg, double longitude_deg, Refraction refraction);

} // namespace pointgi
