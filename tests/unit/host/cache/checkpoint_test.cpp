#include "host/cache/checkpoint.h"
#include "tests/support/temporary_folder.h"
#include <catch2/catch.hpp>

using namespace pointgi;
using namespace pointgi::test;
using Catch::Contains;

namespace {

struct Numbers {
  std::vector<float> values;
  std::vector<std::vector<int>> lists;
  double one = 0.0;
  std::string word;
};

void pack(Packer& to, const Numbers& n) {
  to << n.values << n.lists << n.one << n.word;
}

void unpack(Unpacker& from, Numbers& n) {
  from >> n.values >> n.lists >> n.one >> n.word;
}

const Numbers some{{1.5f, -2.0f}, {{1}, {}, {2, 3}}, 0.25, "three"};

std::string packed(const Numbers& numbers) {
  Packer to;
  pack(to, numbers);
  return to.take();
}

CheckpointOptions in(const TemporaryFolder& folder, bool resumes, std::vector<std::string>* warnings = nullptr) {
  CheckpointOptions options;
  options.folder = folder.file("x.checkpoint");
  options.key = [] { return std::string("scene 1"); };
  options.least_seconds = 0.0;
  options.resumes = resumes;
  if (warnings != nullptr) options.warn = [=](const std::string& text) { warnings->push_back(text); };
  return options;
}

} // namespace

TEST_CASE("checkpoint: values come back as they were packed, and short bytes are not whole") {
  const std::string bytes = packed(some);
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    const std::string part = bytes.substr(0, size);
    Numbers found;
    Unpacker from(part);
    unpack(from, found);
    CHECK(from.is_whole() == (size == bytes.size()));
    if (!from.is_whole()) continue;
    CHECK(found.values == some.values);
    CHECK(found.lists == some.lists);
    CHECK(found.one == some.one);
    CHECK(found.word == some.word);
  }
  const std::string longer = bytes + "x";
  Numbers found;
  Unpacker from(longer);
  unpack(from, found);
  CHECK_FALSE(from.is_whole());
  // A list of 2^62 numbers in eight bytes is not allocated.
  const std::string vast("\0\0\0\0\0\0\0\x40", 8);
  Unpacker of_vast(vast);
  of_vast >> found.values;
  CHECK_FALSE(of_vast.is_whole());
}

TEST_CASE("checkpoint: work is made once, and found by the next run that resumes") {
  const TemporaryFolder folder;
  int made = 0;
  const auto work = [&] {
    ++made;
    return some;
  };
  {
    Checkpoint first(in(folder, false));
    const CheckpointScope scope(&first);
    kept_or_made<Numbers>("light", work);
    kept_or_made<Numbers>("light", work);
    const CheckpointScope none(nullptr);
    kept_or_made<Numbers>("light", work); // nobody's
  }
  CHECK(made == 3);
  CHECK(Checkpoint::is_in(folder.file("x.checkpoint")));
  Checkpoint second(in(folder, true));
  const CheckpointScope scope(&second);
  CHECK(kept_or_made<Numbers>("light", work).values == some.values);
  CHECK(kept_or_made<Numbers>("light", work).lists == some.lists);
  CHECK(made == 3);
  kept_or_made<Numbers>("light", work);
  CHECK(made == 4);
  CHECK(second.found() == 2);
  second.remove();
  CHECK_FALSE(std::filesystem::exists(folder.file("x.checkpoint")));
}

TEST_CASE("checkpoint: what took too little time is not kept, and of what waits the last piece of a name") {
  const TemporaryFolder folder;
  CheckpointOptions patient = in(folder, false);
  patient.least_seconds = 1000.0;
  {
    Checkpoint checkpoint(patient);
    const CheckpointScope scope(&checkpoint);
    kept_or_made<Numbers>("light", [] { return some; });
    checkpoint.keep_soon("rows-0", "first");
    checkpoint.keep_soon("rows-0", "second");
    checkpoint.flush(); // a run that is ended so soon leaves nothing
    CHECK_FALSE(Checkpoint::is_in(patient.folder));
    checkpoint.keep("shafts-1", "a long stage");
    checkpoint.flush();
  }
  Checkpoint next(in(folder, true));
  CHECK(next.find("rows-0") == std::optional<std::string>("second"));
  CHECK_FALSE(next.find("light-1").has_value());
}

TEST_CASE("checkpoint: a damaged piece, and one of another key, are told and not used") {
  const TemporaryFolder folder;
  Checkpoint(in(folder, false)).keep("rows-0", "sixteen pixels");
  const std::string file = folder.file("x.checkpoint/rows-0.kept");
  std::ifstream in_file(file, std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(in_file), {});
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    std::string damaged = whole;
    damaged[byte] = static_cast<char>(damaged[byte] ^ 1);
    std::filesystem::remove(file);
    std::ofstream(file, std::ios::binary) << damaged;
    std::vector<std::string> warnings;
    CHECK_FALSE(Checkpoint(in(folder, true, &warnings)).find("rows-0").has_value());
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Contains(file) && Contains("it is not used"));
  }
  std::ofstream(file, std::ios::binary) << whole;
  CheckpointOptions other = in(folder, true);
  other.key = [] { return std::string("scene 2"); };
  CHECK_FALSE(Checkpoint(other).find("rows-0").has_value());
  CHECK(Checkpoint(in(folder, true)).find("rows-0").has_value());
}

TEST_CASE("checkpoint: another run's pieces stay until the first is kept, and foreign files for ever") {
  const TemporaryFolder folder;
  Checkpoint(in(folder, false)).keep("old", "1");
  const std::string foreign = folder.file("x.checkpoint/notes.txt"), old = folder.file("x.checkpoint/old.kept");
  std::ofstream(foreign) << "mine";
  Checkpoint anew(in(folder, false));
  anew.remove(); // it has kept nothing
  CHECK(std::filesystem::exists(old));
  anew.keep("new", "2");
  CHECK_FALSE(std::filesystem::exists(old));
  anew.remove();
  CHECK(std::filesystem::exists(foreign));
  CHECK_FALSE(Checkpoint::is_in(folder.file("x.checkpoint")));
}

TEST_CASE("checkpoint: a folder that cannot be written is told once") {
  const TemporaryFolder folder;
  folder.write("x.checkpoint", "a file");
  std::vector<std::string> warnings;
  Checkpoint checkpoint(in(folder, false, &warnings));
  checkpoint.keep("a", "1");
  checkpoint.keep("b", "2");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("x.checkpoint") && Contains("goes on without"));
}

TEST_CASE("checkpoint: a second run that writes the same output keeps and finds nothing") {
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  {
    Checkpoint first(in(folder, false));
    first.keep("rows-0", "1");
    for (const bool resumes : {false, true}) {
      CAPTURE(resumes);
      warnings.clear();
      Checkpoint second(in(folder, resumes, &warnings));
      second.keep("rows-0", "2");
      second.keep("rows-1", "2");
      CHECK_FALSE(second.find("rows-0").has_value());
      CHECK_FALSE(second.take_folder());
      second.remove();
      REQUIRE(warnings.size() == 1);
      CHECK_THAT(warnings[0], Contains("x.checkpoint") && Contains("another run") && Contains("goes on without"));
    }
    first.keep("rows-1", "1");
  }
  Checkpoint next(in(folder, true, &warnings));
  CHECK(next.find("rows-0") == std::optional<std::string>("1"));
  CHECK(next.find("rows-1") == std::optional<std::string>("1"));
  next.remove();
  CHECK_FALSE(std::filesystem::exists(folder.file("x.checkpoint")));
  // One that has let go of it makes it anew.
  next.keep("rows-2", "3");
  Checkpoint last(in(folder, true, &warnings));
  last.keep("rows-2", "4");
  CHECK(next.find("rows-2") == std::optional<std::string>("3"));
}

TEST_CASE("checkpoint: a lock that cannot be opened is another run's, and pieces that are only read are found") {
  const TemporaryFolder folder;
  Checkpoint(in(folder, false)).keep("rows-0", "1");
  const std::string lock = folder.file("x.checkpoint/in-use");
  std::filesystem::remove(lock);
  std::filesystem::create_directory_symlink(lock, lock); // a loop
  std::vector<std::string> warnings;
  Checkpoint checkpoint(in(folder, true, &warnings));
  CHECK_FALSE(checkpoint.take_folder());
  CHECK_FALSE(checkpoint.find("rows-0").has_value());
  CHECK(warnings.size() == 1);
  std::filesystem::remove(lock);
  Checkpoint gives_up(in(folder, true, &warnings));
  gives_up.give_up("no memory");
  CHECK(gives_up.find("rows-0") == std::optional<std::string>("1"));
}
