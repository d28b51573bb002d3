// The report of a measurement: the file as it is written, and what a browser shows of it.
#include "host/error.h"
#include "host/measure/report.h"
#include "tests/support/scans.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trade.h"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <png.h>
#include <regex>
#include <string>
#include <vector>

using namespace pointgi;
using test::contents;
using test::TemporaryFolder;

namespace {

void write_grey(const std::string& path, unsigned char green) {
  std::vector<unsigned char> pixels;
  for (int i = 0; i < 16 * 12; ++i)
    pixels.insert(pixels.end(), {100, green, 100});
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 16;
  image.height = 12;
  image.format = PNG_FORMAT_RGB;
  REQUIRE(png_image_write_to_file(&image, path.c_str(), 0, pixels.data(), 0, nullptr) != 0);
}

/// Some of its pictures are there; one is no picture.
Trade trade_with_pictures(const TemporaryFolder& folder) {
  std::filesystem::create_directory(folder.file("pictures"));
  write_grey(folder.file("pictures/reference.png"), 100);
  write_grey(folder.file("pictures/directions-64.png"), 117);
  write_grey(folder.file("pictures/directions-512.png"), 102);
  write_grey(folder.file("pictures/own.png"), 102);
  folder.write("pictures/directions-1.png", "secret");
  return test::small_trade();
}

/// The JSON that the page holds in the element `id`.
nlohmann::json held(const std::string& page, const std::string& id) {
  const std::string open = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t begin = page.find(open);
  REQUIRE(begin != std::string::npos);
  const std::size_t end = page.find("</script>", begin);
  return nlohmann::json::parse(page.substr(begin + open.size(), end - begin - open.size()));
}

std::string browser() {
  for (const std::string name : {"chromium", "chromium-browser", "google-chrome"})
    if (std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0) return name;
  return {};
}

/// The page after its scripts have run, without them. `state`: what stands behind # in the address.
std::string shown(const std::string& program, const TemporaryFolder& folder, const std::string& state) {
  const std::string command = "timeout 300 " + program + " --headless --no-sandbox --disable-gpu --user-data-dir='" +
                              folder.file("profile") + "' --virtual-time-budget=10000 --dump-dom 'file://" +
                              folder.file("report.html") + "#" + state + "' >'" + folder.file("dom") + "' 2>/dev/null";
  REQUIRE(std::system(command.c_str()) == 0);
  std::string page = contents(folder.file("dom"));
  for (std::size_t at; (at = page.find("<script")) != std::string::npos;)
    page.erase(at, page.find("</script>", at) + 9 - at);
  return page;
}

/// The value of `name` in the first tag that has the text `mark`.
std::string attribute(const std::string& page, const std::string& mark, const std::string& name) {
  const std::size_t at = page.find(mark);
  INFO(mark);
  REQUIRE(at != std::string::npos);
  const std::size_t begin = page.rfind('<', at), end = page.find('>', at);
  const std::string tag = page.substr(begin, end - begin);
  const std::size_t value = tag.find(name + "=\"");
  if (value == std::string::npos) return "absent";
  const std::size_t first = value + name.size() + 2;
  return tag.substr(first, tag.find('"', first) - first);
}

/// What a reader sees between the texts `from` and `to`.
std::string text_between(const std::string& page, const std::string& from, const std::string& to) {
  const std::size_t begin = page.find(from);
  REQUIRE(begin != std::string::npos);
  std::string text = page.substr(begin, page.find(to, begin) - begin);
  text = std::regex_replace(text, std::regex("<[^>]*>"), "");
  for (const auto& [code, sign] : {std::pair("&lt;", "<"), {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}})
    text = std::regex_replace(text, std::regex(code), sign);
  return text;
}

} // namespace

TEST_CASE("a report is one file that holds the measurement and its pictures and fetches nothing") {
  const TemporaryFolder folder;
  const Trade trade = trade_with_pictures(folder);
  write_report(trade, json_of(trade), folder.file(""));
  const std::string page = contents(folder.file("report.html"));

  CHECK(held(page, "trade") == nlohmann::json::parse(json_of(trade)));
  const nlohmann::json commands = held(page, "commands");
  CHECK(commands.size() == 5);
  CHECK(commands.at("directions-64") == command_of(trade, trade.runs[1]));
  const nlohmann::json pictures = held(page, "embedded");
  CHECK(pictures.size() == 4);
  CHECK(pictures.at("pictures/directions-512.png") == "pictures/own.png"); // the same, kept once
  const std::string start = "data:image/png;base64,iVBORw0KGgo";
  CHECK(pictures.at("pictures/directions-64.png").get<std::string>().substr(0, start.size()) == start);

  CHECK(page.find("http://") == std::string::npos);
  CHECK(page.find("https://") == std::string::npos);
  CHECK(page.find("default-src 'none'") != std::string::npos);
  CHECK(page.find("{{") == std::string::npos);
  CHECK(page.find("<b>") == std::string::npos);
  CHECK(page.find("\u2028") == std::string::npos);
}

TEST_CASE("a report that cannot be written is an error of output") {
  const TemporaryFolder folder;
  const Trade trade;
  try {
    write_report(trade, json_of(trade), folder.file("missing"));
    FAIL("was written");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::output);
  }
}

TEST_CASE("a browser shows the figures of the measurement and the settings that answer a wish") {
  const std::string program = browser();
  if (program.empty()) {
    WARN("skipped: no chromium is installed");
    test::something_skipped = true;
    return;
  }
  const TemporaryFolder folder;
  Trade trade = trade_with_pictures(folder);
  write_report(trade, json_of(trade), folder.file(""));
  const std::vector<std::size_t> front = mark_front(trade);
  const auto name_at = [&](const std::optional<std::size_t>& at) { return at ? trade.runs[*at].name : std::string(); };
  const Estimate own = trade.runs[0].error;

  SECTION("as it opens") {
    const std::string page = shown(program, folder, "");
    const std::string table =
        page.substr(page.find("<table id=\"best\""), page.find("<table id=\"all\"") - page.find("<table id=\"best\""));
    const std::regex row("<tr data-run=\"([^\"]*)\" data-seconds=\"([^\"]*)\" data-error=\"([^\"]*)\"");
    std::size_t rows = 0;
    for (std::sregex_iterator it(table.begin(), table.end(), row), end; it != end; ++it, ++rows) {
      REQUIRE(rows < front.size());
      const MeasuredRun& run = trade.runs[front[rows]];
      CHECK((*it)[1] == run.name);
      CHECK(std::stod((*it)[2]) == run.seconds.value);
      CHECK(std::stod((*it)[3]) == run.error.value);
    }
    CHECK(rows == front.size());

    CHECK(attribute(page, "data-sentence=\"half-time\"", "data-run") ==
          name_at(most_accurate_within(trade, 0.5 * full_seconds(trade, trade.runs[0]))));
    CHECK(attribute(page, "data-sentence=\"half-error\"", "data-run") ==
          name_at(fastest_within_error(trade, 0.5 * own.value)));
    CHECK(attribute(page, "id=\"for-error\"", "data-run") == name_at(fastest_within_error(trade, own.value / 2)));
    CHECK(text_between(page, "<span id=\"scene\"", "</h1>") == trade.scene.substr(trade.scene.rfind('/') + 1));
    CHECK(text_between(page, "data-refused=\"directions-65536\"", "</tr>").find("more memory than the device has") !=
          std::string::npos);
    CHECK(text_between(page, "id=\"knobs-left\"", "</ul>").find("no specular surface") != std::string::npos);
    CHECK(page.find("NaN") == std::string::npos);
  }
  SECTION("with an error and a time that are wanted, and pictures flipped") {
    const std::string page =
        shown(program, folder, "error=6e-3&seconds=1.5&select=directions-64&against=directions-512&flip=1");
    const std::optional<std::size_t> fastest = fastest_within_error(trade, 6e-3);
    REQUIRE(fastest);
    CHECK(attribute(page, "id=\"for-error\"", "data-run") == name_at(fastest));
    CHECK(attribute(page, "id=\"for-seconds\"", "data-run") == name_at(most_accurate_within(trade, 1.5)));
    const std::string card = page.substr(page.find("id=\"for-error\""));
    CHECK(text_between(card, "<code", "</code>") == command_of(trade, trade.runs[*fastest]));
    CHECK(attribute(page, "id=\"pictures\"", "data-a") == "directions-64");
    CHECK(attribute(page, "id=\"pictures\"", "data-b") == "directions-512");
    CHECK(attribute(page, "id=\"pictures\"", "data-view") == "flip");
    CHECK(attribute(page, "id=\"pictures\"", "data-flip") == "1");
    CHECK(text_between(page, "<figcaption", "</figcaption>").substr(0, 16) == "B directions-512");
  }
  SECTION("with wishes that nothing fulfils, and the difference of two pictures") {
    const std::string page = shown(program, folder, "error=-1&seconds=0.1&select=directions-64&view=heat");
    CHECK(attribute(page, "id=\"for-error\"", "data-run").empty());
    CHECK(attribute(page, "id=\"for-seconds\"", "data-run").empty());
    CHECK(attribute(page, "id=\"pictures\"", "data-b") == "reference");
    CHECK(attribute(page, "id=\"pictures\"", "data-mean-difference") == "17.0000");
  }
  SECTION("of a picture that is not there, it says so") {
    const std::string page = shown(program, folder, "select=directions-1&view=slide");
    CHECK(text_between(page, "id=\"pictures\"", "</section>").find("No picture of directions-1") != std::string::npos);
  }
}
