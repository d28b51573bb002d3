/// Writes small sound files for every fuzz target: write_fuzz_corpus FOLDER puts those of fuzz_NAME into FOLDER/NAME.
#include "host/cache/vmap_cache.h"
#include "host/cloud/readers/readers.h"
#include "host/image/picture_writer.h"
#include "host/measure/kept_errors.h"
#include "host/scene/tuned_file.h"
#include "tests/fuzz/targets/cache_case.h"
#include "tests/fuzz/targets/cloud_targets.h"
#include "tests/support/hdr_bytes.h"
#include "tests/support/markdown.h"
#include "tests/support/mesh_bytes.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trade.h"
#include <cstdio>
#include <filesystem>
#include <map>

using namespace pointgi;
using namespace pointgi::test;

namespace {

namespace fs = std::filesystem;

class Corpus {
public:
  explicit Corpus(fs::path folder) : folder_(std::move(folder)) {}

  void add(const std::string& target, const std::string& bytes) {
    const fs::path folder = folder_ / target;
    fs::create_directories(folder);
    const std::string name = "seed_" + std::to_string(++count_[target]);
    if (!(std::ofstream(folder / name, std::ios::binary) << bytes))
      throw std::runtime_error((folder / name).string() + ": cannot be written");
  }

private:
  fs::path folder_;
  std::map<std::string, int> count_;
};

const CloudReader& reader_of(std::string_view format) {
  for (const CloudReader& reader : cloud_readers())
    if (format == reader.format) return reader;
  throw std::runtime_error("cloud_targets names a format that is not read: " + std::string(format));
}

/// Each reader with a target of its own, or this throws.
void add_clouds(Corpus& corpus) {
  for (const CloudSeed& seed : cloud_seeds()) {
    bool used = false;
    for (const CloudTarget& target : cloud_targets) {
      if (reader_of(target.format).read != reader_of(seed.format).read) continue;
      used = true;
      corpus.add(target.name, seed.pack && !target.inside ? seed.pack(seed.bytes) : seed.bytes);
    }
    if (!used) throw std::runtime_error("no fuzz target reads " + seed.format + "; add it to cloud_targets");
  }
}

void add_maps(Corpus& corpus) {
  std::vector<Rgbe> pixels;
  for (int i = 0; i < 16 * 8; ++i)
    pixels.push_back(i % 16 < 5 ? rgbe(0.5f, 1.0f, 2.0f) : Rgbe{200, static_cast<std::uint8_t>(2 * i), 7, 120});
  for (const HdrCode code : {HdrCode::flat, HdrCode::old_runs, HdrCode::new_runs})
    corpus.add("hdr", hdr_file(16, 8, pixels, code));
  corpus.add("hdr", hdr_header(2, 1, "EXPOSURE=2.5\nCOLORCORR=1 1.5 2\nFORMAT=32-bit_rle_rgbe\n", "+-") +
                        hdr_row({pixels[0], pixels[9]}, HdrCode::flat));
  const TemporaryFolder folder;
  const std::vector<ChannelName> channels{{"R", false}, {"G", false}, {"B", false}, {"PointId", true}};
  PictureAttributes attributes;
  attributes.text["software"] = "pointgi";
  attributes.number["samplesPerPixel"] = 4.0;
  PictureWriter writer(folder.file("map.exr"), 8, 4, {0, 8, 0, 4}, channels, attributes, 0.0);
  Band band{0, 4, 8, std::vector<std::vector<float>>(channels.size(), std::vector<float>(32, 0.5f))};
  for (std::size_t i = 0; i < 32; ++i)
    band.values[0][i] = static_cast<float>(i);
  writer.write(band);
  writer.finish(1.0);
  corpus.add("exr", contents(folder.file("map.exr")));
}

/// The text, with all clouds in cloud.ply and maps in sky.hdr, where the target has put files.
std::string with_files_there(const std::string& text) {
  const std::regex cloud("\\bfile *= *\"[^\"]*\""), map("\\bmap *= *\"[^\"]*\"");
  return std::regex_replace(std::regex_replace(text, cloud, "file = \"cloud.ply\""), map, "map = \"sky.hdr\"");
}

void add_scenes(Corpus& corpus) {
  const fs::path sources = POINTGI_SOURCE_DIR;
  for (const auto& entry : fs::recursive_directory_iterator(sources / "scenes"))
    if (entry.path().extension() == ".toml") corpus.add("scene", with_files_there(contents(entry.path().string())));
  for (const auto& entry : fs::recursive_directory_iterator(sources / "docs")) {
    if (entry.path().extension() != ".md") continue;
    for (const FencedBlock& block : read_markdown(entry.path()).blocks) {
      if (block.kind.rfind("toml", 0) != 0) continue;
      std::string text = block.kind == "toml" ? "" : "version = 1\n";
      for (const std::string& line : block.lines)
        text += line + "\n";
      corpus.add("scene", with_files_there(text));
    }
  }
  const std::string scene = with_files_there(contents((sources / "scenes/demo/room.toml").string()));
  corpus.add("scene", "#set render.spp=64\n#set light.0.power_w=[1, 2, 3]\n#set radiosity.method=direct\n" + scene);
}

void add_settings(Corpus& corpus) {
  TunedFile tuned;
  tuned.octree.branching = 2;
  tuned.octree.order = PointOrder{};
  tuned.octree.leaf_capacity = 16;
  tuned.traversal.form = TraversalForm{};
  tuned.traversal.grouping = RayGrouping{};
  tuned.traversal.group = work_groups().front();
  tuned.traversal.lanes = 8;
  tuned.traversal.storage = PoolStorage{};
  tuned.device = tuned.driver = tuned.version = tuned.scene = "a device";
  tuned.date = "2026-01-02";
  tuned.rays_per_second = 1e6;
  corpus.add("tuned", tuned_text(tuned));
}

void add_measurements(Corpus& corpus) {
  const Trade trade = small_trade();
  corpus.add("trade", json_of(trade));
  ErrorOfRepeats errors;
  errors.add(std::vector<double>(static_cast<std::size_t>(trade.width * trade.height), 1e-3), trade.width, trade.height,
             1e-4);
  const TemporaryFolder folder;
  keep_errors({{trade.runs[0].name, errors}, {trade.runs[1].name, errors}}, trade, folder.file("errors"));
  corpus.add("errors", contents(folder.file("errors")));
}

void add_caches(Corpus& corpus) {
  const TemporaryFolder folder;
  setenv("POINTGI_CACHE_DIR", folder.file("cache").c_str(), 1);
  VMap map;
  map.links = {{0, 1, 0.5f, LinkKind::far, no_point_shares}, {1, 2, 1.0f, LinkKind::near_, 0}};
  map.point_shares.assign(5, 200);
  store_vmap(cache_key, map);
  store_binary(cache_key, {1, 2, 3, 4, 5});
  for (const auto& entry : fs::recursive_directory_iterator(folder.file("cache")))
    if (entry.is_regular_file())
      corpus.add(entry.path().extension() == ".vmap" ? "vmap" : "binary", contents(entry.path().string()));
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_fuzz_corpus FOLDER\n");
    return 2;
  }
  try {
    Corpus corpus(argv[1]);
    add_clouds(corpus);
    for (const auto& [target, bytes] : mesh_seeds())
      corpus.add(target, bytes);
    add_maps(corpus);
    add_scenes(corpus);
    add_settings(corpus);
    add_measurements(corpus);
    add_caches(corpus);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "write_fuzz_corpus: %s\n", error.what());
    return 1;
  }
  return 0;
}
