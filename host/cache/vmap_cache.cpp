#include "host/cache/vmap_cache.h"
#include "host/atomic_file.h"
#include "host/cache/binary_cache.h"
#include "host/cache/cache_bound.h"
#include "host/run.h"
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace pointgi {

namespace {

constexpr char magic[8] = {'p', 'g', 'i', 'v', 'm', 'a', 'p', '\n'};
/// To be raised with every change of the file, and of what make_links makes of one key.
constexpr std::uint32_t version = 9;
constexpr std::uint32_t byte_order = 0x01020304u; ///< as this machine writes it

/// A link without the padding of the struct, whose bytes are anybody's.
struct FileLink {
  std::uint32_t a, b;
  float visible;
  std::uint32_t kind;
  std::uint32_t point_shares;
};

/// File: header, key, links, shares of points.
struct Header {
  char magic_word[8];
  std::uint32_t version, byte_order;
  std::uint32_t header_size, link_size;
  std::uint64_t key_size, link_count, share_count;
  LinkStatistics statistics;
  std::uint64_t content_hash; ///< of header (this field 0) and all that follows
};
static_assert(sizeof(FileLink) == 20 && sizeof(Header) == 48 + sizeof(LinkStatistics) + 8, "no padding in the file");

template <typename T>
std::string_view bytes_of(const T* data, std::size_t count) {
  return {reinterpret_cast<const char*>(data), count * sizeof(T)};
}

std::uint64_t hash_of(Header header, const std::string& key, const std::vector<FileLink>& links,
                      const std::vector<std::uint8_t>& shares) {
  header.content_hash = 0;
  const std::uint64_t of_links = fnv1a(bytes_of(links.data(), links.size()), fnv1a(key, fnv1a(bytes_of(&header, 1))));
  return fnv1a(bytes_of(shares.data(), shares.size()), of_links);
}

bool believable(const FileLink& l, const ClusterTree& tree, std::uint64_t shares) {
  return l.a <= l.b && l.b < tree.nodes.size() && l.visible > 0.0f && l.visible <= 1.0f &&
         l.kind <= static_cast<std::uint32_t>(LinkKind::near_) &&
         (l.point_shares == no_point_shares ||
          std::uint64_t{l.point_shares} + tree.nodes[l.a].count + tree.nodes[l.b].count <= shares);
}

/// Whether a file of `size` bytes holds what its header says.
bool fits(const Header& header, std::uint64_t size) {
  std::uint64_t rest = size - sizeof header;
  if (header.key_size > rest) return false;
  rest -= header.key_size;
  if (header.link_count > rest / sizeof(FileLink)) return false;
  return header.share_count == rest - header.link_count * sizeof(FileLink);
}

template <typename T>
bool read_into(std::ifstream& file, T* data, std::size_t count) {
  return static_cast<bool>(file.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(count * sizeof(T))));
}

/// What is wrong with the open file; empty and `map` filled when nothing is.
std::string read_map(std::ifstream& file, std::uint64_t size, const std::string& key, const ClusterTree& tree,
                     VMap& map) {
  Header header{};
  if (!read_into(file, &header, 1) || std::memcmp(header.magic_word, magic, sizeof magic) != 0) return "is no V-map";
  if (header.version != version || header.byte_order != byte_order || header.header_size != sizeof header ||
      header.link_size != sizeof(FileLink))
    return "is of another version or machine";
  // Before anything is allocated: sizes of a damaged file may be any number.
  if (!fits(header, size)) return "is cut short or too long";
  std::string found_key(header.key_size, '\0');
  std::vector<FileLink> links(header.link_count);
  map.point_shares.resize(header.share_count);
  if (!read_into(file, found_key.data(), found_key.size()) || !read_into(file, links.data(), links.size()) ||
      !read_into(file, map.point_shares.data(), map.point_shares.size()))
    return "cannot be read";
  if (hash_of(header, found_key, links, map.point_shares) != header.content_hash) return "is damaged";
  if (found_key != key) return "is the V-map of another scene";
  map.statistics = header.statistics;
  map.links.reserve(links.size());
  for (const FileLink& l : links) {
    if (!believable(l, tree, map.point_shares.size())) return "has links that the scene cannot have";
    map.links.push_back({l.a, l.b, l.visible, static_cast<LinkKind>(l.kind), l.point_shares});
  }
  return {};
}

} // namespace

std::string vmap_key(const ClusterTree& tree, View<Splat> splats, const LinkOptions& options,
                     const std::string& answered_by) {
  char text[400];
  std::snprintf(text, sizeof text,
                "vmap %u; %zu clusters %016llx; %zu points %016llx; %zu splats %016llx; samples %u epsilon %a "
                "separation %a seed %u point samples %u thesis %d rays %llu; ",
                version, tree.nodes.size(),
                static_cast<unsigned long long>(fnv1a(bytes_of(tree.nodes.data(), tree.nodes.size()))),
                tree.points.size(),
                static_cast<unsigned long long>(fnv1a(bytes_of(tree.points.data(), tree.points.size()))), splats.size,
                static_cast<unsigned long long>(fnv1a(bytes_of(splats.data, splats.size))), options.samples,
                static_cast<double>(options.epsilon), static_cast<double>(options.separation), options.seed,
                options.point_samples, options.thesis ? 1 : 0, static_cast<unsigned long long>(options.most_rays));
  return text + answered_by;
}

namespace {

thread_local int not_kept = 0; ///< NoVMapsKept that live

} // namespace

NoVMapsKept::NoVMapsKept() {
  ++not_kept;
}

NoVMapsKept::~NoVMapsKept() {
  --not_kept;
}

std::string vmap_file(const std::string& key) {
  const std::string folder = not_kept > 0 ? std::string() : cache_folder();
  if (folder.empty()) return {};
  char name[40];
  std::snprintf(name, sizeof name, "/%016llx.vmap", static_cast<unsigned long long>(fnv1a(key)));
  return folder + "/vmaps" + name;
}

KeptVMap load_vmap(const std::string& key, const ClusterTree& tree) {
  const std::string path = vmap_file(key);
  std::error_code failed;
  if (path.empty() || !std::filesystem::exists(path, failed)) return {};
  const auto warned = [&](const std::string& what) {
    return KeptVMap{std::nullopt, path + ": " + what + "; it is not used, and the V-map is made again"};
  };
  if (!std::filesystem::is_regular_file(path, failed)) return warned("is no file");
  const std::uint64_t size = std::filesystem::file_size(path, failed);
  std::ifstream file(path, std::ios::binary);
  if (failed || !file) return warned("cannot be read");
  VMap map;
  const std::string wrong = read_map(file, size, key, tree, map);
  if (!wrong.empty()) return warned(wrong);
  mark_as_used(path);
  return {std::move(map), {}};
}

void store_vmap(const std::string& key, const VMap& map) {
  const std::string path = vmap_file(key);
  if (path.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  std::vector<FileLink> links;
  links.reserve(map.links.size());
  for (const Link& l : map.links)
    links.push_back({l.a, l.b, l.visible, static_cast<std::uint32_t>(l.kind), l.point_shares});
  Header header{{},
                version,
                byte_order,
                sizeof(Header),
                sizeof(FileLink),
                key.size(),
                links.size(),
                map.point_shares.size(),
                map.statistics,
                0};
  std::memcpy(header.magic_word, magic, sizeof magic);
  header.content_hash = hash_of(header, key, links, map.point_shares);
  try {
    AtomicFile file(path);
    file.write(&header, sizeof header);
    file.write(key.data(), key.size());
    file.write(links.data(), links.size() * sizeof(FileLink));
    file.write(map.point_shares.data(), map.point_shares.size());
    file.commit();
  } catch (const Error&) {
    // Documented: without a cache the next run makes it again.
  }
  bound_cache(cache_folder(), most_cache_bytes());
}

VMap kept_or_made_links(const ClusterTree& tree, View<Splat> splats, VisibilityOracle& oracle,
                        const LinkOptions& options, const std::string& answered_by, bool* was_kept) {
  const std::string key = vmap_key(tree, splats, options, answered_by);
  KeptVMap kept = load_vmap(key, tree);
  if (!kept.warning.empty()) log_warning("{}", kept.warning);
  if (was_kept != nullptr) *was_kept = kept.map.has_value();
  if (kept.map) return std::move(*kept.map);
  VMap map = make_links(tree, oracle, options, splats);
  store_vmap(key, map);
  return map;
}

} // namespace pointgi
