#include "host/cache/checkpoint.h"
#include "host/atomic_file.h"
#include "host/cache/binary_cache.h"
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pointgi {

namespace {

namespace fs = std::filesystem;

constexpr char magic[8] = {'p', 'g', 'i', 'k', 'e', 'p', 't', '\n'};
constexpr std::uint32_t version = 2;              ///< to be raised with every change of what is kept
constexpr std::uint32_t byte_order = 0x01020304u; ///< as this machine writes it
constexpr const char* extension = ".kept";
constexpr const char* lock_name = "in-use"; ///< locked as long as its run lives
constexpr std::size_t most_waiting_bytes = 64u << 20;

/// File: header, key, bytes.
struct Header {
  char magic_word[8];
  std::uint32_t version, byte_order;
  std::uint64_t key_size, size;
  std::uint64_t hash; ///< of key and bytes
};
static_assert(sizeof(Header) == 40, "no padding in the file");

constexpr const char* given_up = ". The run goes on without keeping what it has done: it could not be resumed";

thread_local Checkpoint* current = nullptr;

std::uint64_t hash_of(const std::string& key, const std::string& bytes) {
  return fnv1a(bytes, fnv1a(key));
}

bool is_kept(const fs::path& file) {
  return file.extension() == extension;
}

/// Ours: finished, or begun by a run that was killed.
bool is_of_checkpoint(const fs::path& file) {
  const std::string name = file.filename().string();
  return is_kept(file) || (name[0] == '.' && file.extension() == ".tmp" && name.find(extension) != std::string::npos);
}

} // namespace

Checkpoint::Checkpoint(CheckpointOptions options) : options_(std::move(options)) {}

Checkpoint::~Checkpoint() {
  let_go();
}

void Checkpoint::let_go() {
  if (lock_ >= 0) close(lock_);
  lock_ = -1;
}

bool Checkpoint::take_folder() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return take_locked();
}

bool Checkpoint::take_locked() {
  if (lock_ >= 0) return true;
  if (refused_) return false;
  const std::string path = (fs::path(options_.folder) / lock_name).string();
  const auto refuse = [&](const std::string& why) {
    refused_ = true;
    warn(why + given_up);
    return false;
  };
  constexpr int attempts = 100; // each is lost to one run that ends in this moment
  for (int attempt = 0; attempt < attempts; ++attempt) {
    std::error_code failed;
    fs::create_directories(options_.folder, failed);
    // Read only: another user's file may be locked, too.
    const int file = open(path.c_str(), O_CREAT | O_RDONLY | O_CLOEXEC, 0666);
    if (file < 0 && errno == ENOENT) continue;
    if (file < 0 && fs::exists(fs::symlink_status(path, failed))) return refuse(path + ": " + std::strerror(errno));
    if (file < 0) return true; // a folder that cannot be written: nobody works in it
    if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(file);
      return refuse(options_.folder + ": another run that writes the same output is at work");
    }
    // Not all file systems have locks. The run that had this one may have removed the file, and another made it anew.
    struct stat opened, named;
    if (fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
        opened.st_ino == named.st_ino) {
      lock_ = file;
      return true;
    }
    close(file);
  }
  return refuse(path + ": cannot be made");
}

bool Checkpoint::is_in(const std::string& folder, const std::string& name) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (is_kept(entry.path()) && entry.path().filename().string().rfind(name, 0) == 0) return true;
  return false;
}

std::string Checkpoint::file_of(const std::string& name) const {
  return (fs::path(options_.folder) / (name + extension)).string();
}

std::string Checkpoint::numbered(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return name + "-" + std::to_string(++numbers_[name]);
}

void Checkpoint::warn(const std::string& text) const {
  if (options_.warn) options_.warn(text);
}

std::optional<std::string> Checkpoint::find(const std::string& name) {
  if (!options_.resumes) return std::nullopt;
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string path = file_of(name);
  std::error_code failed;
  if (!fs::is_regular_file(path, failed) || !take_locked()) return std::nullopt;
  const auto refused = [&](const char* what) {
    warn(path + ": " + what + "; it is not used, and what it should hold is computed again");
    return std::nullopt;
  };
  const std::uint64_t size = fs::file_size(path, failed);
  std::ifstream file(path, std::ios::binary);
  Header header{};
  if (failed || !file.read(reinterpret_cast<char*>(&header), sizeof header)) return refused("cannot be read");
  if (std::memcmp(header.magic_word, magic, sizeof magic) != 0 || header.version != version ||
      header.byte_order != byte_order)
    return refused("is of another version or machine");
  // Before anything is allocated: sizes of a damaged file may be any number.
  const std::uint64_t rest = size - sizeof header;
  if (header.key_size > rest || header.size != rest - header.key_size) return refused("is cut short or too long");
  std::string found_key(header.key_size, '\0'), bytes(header.size, '\0');
  if (!file.read(found_key.data(), static_cast<std::streamsize>(found_key.size())) ||
      !file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    return refused("cannot be read");
  if (hash_of(found_key, bytes) != header.hash) return refused("is damaged");
  if (found_key != key()) {
    if (!foreign_) refused("is of another scene, other settings, or another device, as may be other pieces beside it");
    foreign_ = true;
    return std::nullopt;
  }
  ++found_;
  begun_ = true; // what lies there is this run's own
  return bytes;
}

const std::string& Checkpoint::key() {
  if (!key_) key_ = options_.key();
  return *key_;
}

void Checkpoint::clear() {
  std::error_code ignored;
  std::vector<fs::path> ours;
  for (const auto& entry : fs::directory_iterator(options_.folder, ignored))
    if (is_of_checkpoint(entry.path())) ours.push_back(entry.path());
  for (const fs::path& file : ours)
    fs::remove(file, ignored);
}

void Checkpoint::write_locked(const std::string& name, const std::string& bytes) {
  if (failed_ || !take_locked()) return;
  if (!begun_) clear();
  begun_ = true;
  Header header{{}, version, byte_order, key().size(), bytes.size(), hash_of(key(), bytes)};
  std::memcpy(header.magic_word, magic, sizeof magic);
  try {
    AtomicFile file(file_of(name));
    file.write(&header, sizeof header);
    file.write(key().data(), key().size());
    file.write(bytes.data(), bytes.size());
    kept_ = true;
    file.commit_unsynced(); // the hash tells what a power cut has left of it
  } catch (const Error& error) {
    failed_ = true;
    warn(error.what() + std::string(given_up));
  }
  kept_at_ = Clock::now();
}

void Checkpoint::give_up(const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!failed_) warn(why + given_up);
  failed_ = true;
}

void Checkpoint::keep(const std::string& name, const std::string& bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  write_locked(name, bytes);
}

void Checkpoint::keep_soon(const std::string& name, std::string bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (failed_) return;
  std::string& waiting = waiting_[name];
  waiting_bytes_ += bytes.size() - waiting.size();
  waiting = std::move(bytes);
  if (waiting_bytes_ > most_waiting_bytes || is_worth(seconds_since(kept_at_))) flush_locked();
}

void Checkpoint::flush() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (kept_ || is_worth(seconds_since(kept_at_))) flush_locked();
}

void Checkpoint::flush_locked() {
  for (const auto& [name, bytes] : waiting_)
    write_locked(name, bytes);
  waiting_.clear();
  waiting_bytes_ = 0;
}

void Checkpoint::remove() {
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_.clear();
  waiting_bytes_ = 0;
  if (begun_) clear();
  if (begun_ || (lock_ >= 0 && !is_in(options_.folder))) {
    std::error_code ignored;
    // The lock's file last: until then no other run takes the folder for its own.
    if (lock_ >= 0) fs::remove(fs::path(options_.folder) / lock_name, ignored);
    fs::remove(options_.folder, ignored); // stays where others have put something into it
  }
  let_go();
}

CheckpointScope::CheckpointScope(Checkpoint* checkpoint) : outer_(current) {
  current = checkpoint;
}

CheckpointScope::~CheckpointScope() {
  current = outer_;
}

Checkpoint* current_checkpoint() {
  return current;
}

} // namespace pointgi
