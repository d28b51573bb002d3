/// The sun's position against almanacs and against what the calendar says of solstices and equinoxes.
#include "host/error.h"
#include "host/lights/sun_position.h"
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

using namespace pointgi;

namespace {

DateTime moment(const std::string& date, const std::string& time) {
  const auto day = parse_date(date);
  const auto zoned = parse_zoned_time(time);
  REQUIRE(day);
  REQUIRE(zoned);
  return {*day, zoned->time, zoned->zone};
}

SunPosition sun(const std::string& date, const std::string& time, double latitude = 0.0, double longitude = 0.0,
                Refraction refraction = Refraction::none) {
  return sun_position(moment(date, time), latitude, longitude, refraction);
}

struct Published {
  const char* date;
  const char* time;
  double latitude, longitude, elevation, azimuth;
};

/// What a sun's place in the sky may be off, degrees: a tenth of its disc.
constexpr double tolerance = 0.05;

void check(const Published& truth, Refraction refraction = Refraction::none) {
  INFO(truth.date << " " << truth.time << " at " << truth.latitude << ", " << truth.longitude);
  const SunPosition found = sun(truth.date, truth.time, truth.latitude, truth.longitude, refraction);
  CHECK(found.elevation_deg == Approx(truth.elevation).margin(tolerance));
  CHECK(found.azimuth_deg == Approx(truth.azimuth).margin(tolerance));
}

} // namespace

TEST_CASE("the sun stands where JPL's ephemeris has it, a winter's day through at 50 north") {
  // JPL Horizons (ssd.jpl.nasa.gov/horizons), airless, 2020-01-01, 50 N 10 E, printed in the tests of solposx 1.0
  // (github.com/pvlib/solposx).
  check({"2020-01-01", "00:00Z", 50, 10, -62.107511, 18.384905});
  check({"2020-01-01", "03:00Z", 50, 10, -40.227454, 77.862491});
  check({"2020-01-01", "06:00Z", 50, 10, -11.846393, 111.849769});
  check({"2020-01-01", "08:00Z", 50, 10, 4.244699, 134.336441});
  check({"2020-01-01", "09:00Z", 50, 10, 10.367984, 146.804482});
  check({"2020-01-01", "10:00Z", 50, 10, 14.670438, 160.234863});
  check({"2020-01-01", "11:00Z", 50, 10, 16.791713, 174.399466});
  check({"2020-01-01", "12:00Z", 50, 10, 16.525775, 188.799258});
  check({"2020-01-01", "13:00Z", 50, 10, 13.899667, 202.838039});
  check({"2020-01-01", "15:00Z", 50, 10, 2.693785, 228.325009});
  check({"2020-01-01", "18:00Z", 50, 10, -23.161504, 261.295115});
  check({"2020-01-01", "23:00Z", 50, 10, -62.592241, 348.166418});
}

TEST_CASE("the sun stands where NREL's algorithm has it, at ten places") {
  // Reda and Andreas, "Solar Position Algorithm for Solar Radiation Applications", NREL/TP-560-34302, appendix A.5:
  // topocentric zenith angle 50.11162 with refraction of 0.0139 degrees at 820 mbar, azimuth 194.34024.
  check({"2003-10-17", "12:30:30-07:00", 39.742476, -105.1786, 90.0 - 50.11162, 194.34024}, Refraction::standard);
  // The same algorithm, airless, as printed in the tests of solposx 1.0 (github.com/pvlib/solposx).
  check({"2020-10-17", "12:30+00:00", 45, 10, 32.21708674, 204.9188164});
  check({"2020-10-17", "12:30:10+00:00", 45, 10, 32.20462016, 204.96510208});
  check({"2020-10-17", "12:30+02:00", 45, 10, 34.92249857, 169.3767211});
  check({"2020-10-17", "12:30-02:00", 45, 10, 18.63493009, 234.19049983});
  check({"2020-02-29", "12:30+00:00", 45, 10, 35.75662074, 197.67009996});
  check({"2020-10-17", "12:30+00:00", 90, 10, -9.53051391, 201.18870641});
  check({"2020-10-17", "12:30+00:00", 0, 10, 66.85682918, 245.09065324});
  check({"2020-10-17", "12:30+00:00", -90, 10, 9.52569499, 338.81129359});
  check({"2020-10-17", "12:30+00:00", -45, 10, 50.10653615, 326.23446721});
  check({"2020-10-17", "12:30+00:00", 45, -15, 35.36147343, 175.38931352});
  check({"2020-10-17", "12:30+00:00", 45, -180, -53.24113451, 18.64817122});
  check({"2020-10-17", "12:30+00:00", 45, 180, -53.24113451, 18.64817122});
  check({"1800-10-17", "12:30+00:00", 45, 10, 32.4622024, 204.94926574});
  check({"2200-10-17", "12:30+00:00", 45, 10, 32.4407131, 204.96985758});
  check({"2020-10-17", "03:30+00:00", 45, 10, -23.40808954, 79.54868063});
  check({"2020-10-17", "05:50+00:00", 45, 10, 1.10773228, 104.53989829});
  // Seen through air of 12 °C and 1013 hPa.
  check({"2020-10-17", "12:30+00:00", 45, 10, 32.24367654, 204.9188164}, Refraction::standard);
  check({"2020-10-17", "12:30+00:00", -90, 10, 9.61953906, 338.81129359}, Refraction::standard);
  check({"2020-10-17", "05:50+00:00", 45, 10, 1.45847482, 104.53989829}, Refraction::standard);
}

TEST_CASE("declination and equation of time") {
  // Meeus, "Astronomical Algorithms", 2nd edition, example 25.a: apparent declination -7.78507.
  CHECK(sun("1992-10-13", "00:00Z").declination_deg == Approx(-7.78507).margin(1e-4));
  // Seasons of the US Naval Observatory (aa.usno.navy.mil/data/Earth_Seasons), to the minute. The declination is 0, or
  // as large as the obliquity, 23.4361 in 2024; near an equinox it changes by 0.0165 degrees an hour.
  CHECK(sun("2024-06-20", "20:51Z").declination_deg == Approx(23.4361).margin(0.005));
  CHECK(sun("2024-12-21", "09:21Z").declination_deg == Approx(-23.4361).margin(0.005));
  CHECK(sun("2025-03-20", "09:01Z").declination_deg == Approx(0.0).margin(0.005));
  CHECK(sun("2023-09-23", "06:50Z").declination_deg == Approx(0.0).margin(0.005));
  // NREL's algorithm as printed in the tests of solposx 1.0, minutes. 0.1 minutes are 0.025 degrees.
  CHECK(sun("2020-10-17", "12:30Z").equation_of_time_min == Approx(14.75816).margin(0.1));
  CHECK(sun("2020-02-29", "12:30Z").equation_of_time_min == Approx(-12.43199).margin(0.1));
}

TEST_CASE("at a solstice's noon the sun is over its tropic, and an equinox's sun rises in the east") {
  // Subsolar point: latitude = declination, longitude = 15 degrees an hour from apparent noon at Greenwich.
  const SunPosition june = sun("2024-06-20", "12:00Z");
  const SunPosition above = sun("2024-06-20", "12:00Z", june.declination_deg, -june.equation_of_time_min / 4.0);
  CHECK(above.elevation_deg == Approx(90.0).margin(1e-6));
  // Near the zenith an azimuth is steep: exactly on the meridian it must still be north or south to the last digits.
  const double north =
      sun("2024-06-20", "12:00Z", june.declination_deg - 1e-3, -june.equation_of_time_min / 4.0).azimuth_deg;
  CHECK(std::fmin(north, 360.0 - north) < 1e-6);
  CHECK(sun("2024-06-20", "12:00Z", june.declination_deg + 1e-3, -june.equation_of_time_min / 4.0).azimuth_deg ==
        Approx(180.0).margin(1e-6));
  // Equator, 2025-03-20 at local apparent 6 h and 18 h: the declination is below 0.06 degrees all that day.
  const double equation = sun("2025-03-20", "06:00Z").equation_of_time_min;
  const SunPosition rising = sun("2025-03-20", "06:00Z", 0.0, -equation / 4.0);
  CHECK(rising.elevation_deg == Approx(0.0).margin(1e-6));
  CHECK(rising.azimuth_deg == Approx(90.0).margin(0.07));
  CHECK(sun("2025-03-20", "18:00Z", 0.0, -equation / 4.0).azimuth_deg == Approx(270.0).margin(0.16));
}

TEST_CASE("a zone moves the clock and nothing else") {
  const SunPosition utc = sun("2024-03-01", "01:15:30Z", 12.97, 77.59);
  for (const auto& [date, time] : {std::pair("2024-03-01", "06:45:30+05:30"), std::pair("2024-02-29", "18:15:30-07:00"),
                                   std::pair("2024-03-01", "15:15:30 +14:00")}) {
    const SunPosition local = sun(date, time, 12.97, 77.59);
    CHECK(local.elevation_deg == Approx(utc.elevation_deg).margin(1e-7));
    CHECK(local.azimuth_deg == Approx(utc.azimuth_deg).margin(1e-7));
  }
}

TEST_CASE("refraction lifts the sun, most at the horizon") {
  // 34 arc minutes at the horizon is what almanacs reckon with; nothing near the zenith; no jump from piece to piece
  // larger than 0.01 degrees.
  const double noon = -sun("2024-03-20", "12:00Z").equation_of_time_min / 4.0;
  double before = 0.0;
  for (int i = -20; i <= 900; ++i) {
    const double elevation = 0.1 * i, latitude = 90.0 - elevation + sun("2024-03-20", "12:00Z").declination_deg;
    if (latitude > 90.0) continue;
    const double lift = sun("2024-03-20", "12:00Z", latitude, noon, Refraction::standard).elevation_deg -
                        sun("2024-03-20", "12:00Z", latitude, noon).elevation_deg;
    CHECK(lift >= 0.0);
    if (i == 0) CHECK(60.0 * lift == Approx(34.0).margin(6.0)); // NOAA's fit has 29 at a true elevation of 0
    if (i > 10 && before > 0.0) CHECK(lift <= before + 1e-9);
    if (i > 850) CHECK(lift == 0.0);
    before = lift;
  }
}

TEST_CASE("dates, times and zones as a scene writes them") {
  const auto date = parse_date("2024-02-29");
  REQUIRE(date);
  CHECK(date->year == 2024);
  CHECK(date->month == 2);
  CHECK(date->day == 29);
  for (const char* wrong :
       {"2023-02-29", "1900-02-29", "2024-13-01", "2024-00-10", "2024-04-31", "2024-4-30", "24-04-30", "2024-04-30 ",
        "2024/04/30", "", "1799-12-31", "2201-01-01", "2024-04-0x", "20 4-04-30"})
    CHECK_FALSE(parse_date(wrong));
  CHECK(parse_date("2000-02-29"));
  CHECK(parse_zone("+05:30")->minutes == 330);
  CHECK(parse_zone("-07:00")->minutes == -420);
  CHECK(parse_zone("-00:30")->minutes == -30);
  CHECK(parse_zone("Z")->minutes == 0);
  for (const char* wrong : {"", "5", "05:30", "+5:30", "+0530", "+14:01", "-15:00", "+05:60", "+05:30x", "UTC"})
    CHECK_FALSE(parse_zone(wrong));
  CHECK(parse_clock("23:59:59.75")->second == Approx(59.75));
  for (const char* wrong :
       {"", "24:00", "12", "12:60", "12:00:60", "12:00:5", "12:00:05.", "1:00", "12:00:00.5s", "-1:00"})
    CHECK_FALSE(parse_clock(wrong));
  const auto zoned = parse_zoned_time("09:05:07 -03:30");
  REQUIRE(zoned);
  CHECK(zoned->time.hour == 9);
  CHECK(zoned->time.minute == 5);
  CHECK(zoned->time.second == 7.0);
  CHECK(zoned->zone.minutes == -210);
  for (const char* wrong : {"12:00", "Z", "12:00  Z", "+05:30", "12:00+5", "12:00Z+01:00"})
    CHECK_FALSE(parse_zoned_time(wrong));
}

TEST_CASE("a place or time that is none is refused with what is right") {
  const DateTime good = moment("2024-06-20", "12:00Z");
  const auto message = [](const DateTime& when, double latitude, double longitude) {
    try {
      sun_position(when, latitude, longitude, Refraction::none);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::input);
      CHECK_FALSE(error.remedy().empty());
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message(good, 90.0, -180.0).empty());
  CHECK_THAT(message(good, 90.1, 0.0), Catch::Contains("latitude") && Catch::Contains("-90 to 90"));
  CHECK_THAT(message(good, NAN, 0.0), Catch::Contains("latitude"));
  CHECK_THAT(message(good, 0.0, 181.0), Catch::Contains("longitude") && Catch::Contains("-180 to 180"));
  DateTime bad = good;
  bad.date.day = 31;
  CHECK_THAT(message(bad, 0.0, 0.0), Catch::Contains("date"));
  bad = good;
  bad.time.minute = 60;
  CHECK_THAT(message(bad, 0.0, 0.0), Catch::Contains("time"));
  bad = good;
  bad.zone.minutes = 841;
  CHECK_THAT(message(bad, 0.0, 0.0), Catch::Contains("zone"));
}
