#include "host/image/exr_writer.h"
#include "host/atomic_file.h"
#include "host/error.h"
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <unistd.h>
#include <utility>

namespace pointgi {

namespace {

const char render_time_attribute[] = "renderTimeSeconds";

/// Bytes at a position of the file, all of them. Returns 0 or the errno.
int write_at(int fd, const char* bytes, std::size_t count, std::uint64_t position) {
  while (count > 0) {
    const ssize_t written = ::pwrite(fd, bytes, count, static_cast<off_t>(position));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written == 0 ? ENOSPC : errno;
    bytes += written;
    position += static_cast<std::uint64_t>(written);
    count -= static_cast<std::size_t>(written);
  }
  return 0;
}

/// OpenEXR's own file stream buffers, and loses the errors of its last flush in a destructor; this one keeps the first
/// error for whoever asks.
class FdStream : public Imf::OStream {
public:
  explicit FdStream(const AtomicFile& file) : Imf::OStream(file.final_path().c_str()), file_(file) {}

  void write(const char bytes[], int count) override {
    const int failed = write_at(file_.fd(), bytes, static_cast<std::size_t>(count), position_);
    if (failed != 0) {
      if (error_number_ == 0) error_number_ = failed;
      check();
    }
    position_ += static_cast<std::uint64_t>(count);
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  void check() const {
    if (error_number_ != 0) throw output_error(file_.final_path(), "write the file", error_number_);
  }

private:
  const AtomicFile& file_;
  std::uint64_t position_ = 0;
  int error_number_ = 0;
};

/// What a writer has written, before the file has its name.
class FdInput : public Imf::IStream {
public:
  explicit FdInput(const AtomicFile& file) : Imf::IStream(file.final_path().c_str()), file_(file) {}

  bool read(char bytes[], int count) override {
    for (int done = 0; done < count;) {
      const ssize_t got =
          ::pread(file_.fd(), bytes + done, static_cast<std::size_t>(count - done), static_cast<off_t>(position_));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) throw output_error(file_.final_path(), "read back the file", got == 0 ? EIO : errno);
      done += static_cast<int>(got);
      position_ += static_cast<std::uint64_t>(got);
    }
    return true;
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

private:
  const AtomicFile& file_;
  std::uint64_t position_ = 0;
};

/// Runs a call into OpenEXR; what it throws becomes our error.
template <class Call>
void guarded(const std::string& path, Call&& call) {
  try {
    call();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::output,
                path + ": OpenEXR cannot write the file: " + error.what() + "; check the folder and the disk");
  }
}

Imath::M44f matrix_of(const std::array<float, 16>& values) {
  Imath::M44f matrix;
  std::copy(values.begin(), values.end(), matrix.getValue());
  return matrix;
}

Imf::Header make_header(int full_width, int full_height, PixelWindow window, const std::vector<ChannelName>& channels,
                        const PictureAttributes& attributes) {
  const Imath::Box2i display({0, 0}, {full_width - 1, full_height - 1});
  const Imath::Box2i data({window.x0, window.y0}, {window.x1 - 1, window.y1 - 1});
  // Pixel aspect 1, screen window centred and 1 wide: a plain picture.
  Imf::Header header(display, data, 1.0f, {0.0f, 0.0f}, 1.0f, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
  for (const ChannelName& channel : channels)
    header.channels().insert(channel.name, Imf::Channel(channel.is_uint ? Imf::UINT : Imf::FLOAT));
  Imf::addChromaticities(header, Imf::Chromaticities()); // the default is Rec. 709 with D65
  Imf::addWorldToCamera(header, matrix_of(attributes.world_to_camera));
  Imf::addWorldToNDC(header, matrix_of(attributes.world_to_ndc));
  for (const auto& [name, value] : attributes.text)
    header.insert(name, Imf::StringAttribute(value));
  for (const auto& [name, value] : attributes.number)
    header.insert(name, Imf::FloatAttribute(static_cast<float>(value)));
  // Its place is kept now, its value comes in close(): OpenEXR writes the header before the first row.
  header.insert(render_time_attribute, Imf::FloatAttribute(0.0f));
  return header;
}

std::uint32_t read_le32(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i)
    value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  return value;
}

/// Where the value of a float attribute stands in the file. A header is magic and version (4 bytes each), then for
/// every attribute its name\0, type\0, size (32 bits, little-endian) and value; an empty name ends it. Source: "OpenEXR
/// File Layout", §Header.
std::optional<std::uint64_t> find_float_attribute(const std::string& header, const std::string& wanted) {
  std::size_t at = 8;
  while (at < header.size() && header[at] != '\0') {
    const std::size_t name_end = header.find('\0', at);
    if (name_end == std::string::npos) return std::nullopt;
    const std::size_t type_end = header.find('\0', name_end + 1);
    if (type_end == std::string::npos || type_end + 5 > header.size()) return std::nullopt;
    const std::uint32_t size = read_le32(header.data() + type_end + 1);
    if (header.compare(at, name_end - at, wanted) == 0)
      return size == 4 ? std::optional<std::uint64_t>(type_end + 5) : std::nullopt;
    at = type_end + 5 + size;
  }
  return std::nullopt;
}

} // namespace

struct ExrWriter::State {
  explicit State(const std::string& path) : file(path), stream(file) {}

  AtomicFile file;
  FdStream stream;
  std::optional<Imf::OutputFile> image; ///< after the stream: its destructor still writes there
  std::vector<ChannelName> channels;
  PixelWindow window;
  std::uint64_t render_time_at = 0;
  std::optional<std::uint64_t> exposure_at;
};

ExrWriter::ExrWriter(const std::string& path, int full_width, int full_height, PixelWindow window,
                     std::vector<ChannelName> channels, const PictureAttributes& attributes)
    : state_(std::make_unique<State>(path)) {
  State& state = *state_;
  state.channels = std::move(channels);
  state.window = window;
  guarded(path, [&] {
    state.image.emplace(state.stream, make_header(full_width, full_height, window, state.channels, attributes));
  });
  std::string header(state.stream.tellp(), '\0');
  const ssize_t got = ::pread(state.file.fd(), header.data(), header.size(), 0);
  if (got < 0) throw output_error(path, "read back the header", errno);
  header.resize(static_cast<std::size_t>(got));
  const auto place = find_float_attribute(header, render_time_attribute);
  if (!place) throw Error(ErrorKind::internal, path + ": the header just written lacks " + render_time_attribute);
  state.render_time_at = *place;
  state.exposure_at = find_float_attribute(header, exposure_attribute);
}

ExrWriter::~ExrWriter() = default;

void ExrWriter::write(const Band& band) {
  State& state = *state_;
  guarded(state.file.final_path(), [&] {
    Imf::FrameBuffer pixels;
    const Imath::V2i origin(state.window.x0, band.first_row);
    const std::size_t row_bytes = sizeof(float) * static_cast<std::size_t>(band.width);
    for (std::size_t c = 0; c < state.channels.size(); ++c)
      pixels.insert(state.channels[c].name,
                    Imf::Slice::Make(state.channels[c].is_uint ? Imf::UINT : Imf::FLOAT, band.values[c].data(), origin,
                                     band.width, band.rows, sizeof(float), row_bytes));
    state.image->setFrameBuffer(pixels);
    state.image->writePixels(band.rows);
  });
}

void ExrWriter::write_zeros(int rows) {
  State& state = *state_;
  guarded(state.file.final_path(), [&] {
    state.image->setFrameBuffer(Imf::FrameBuffer()); // OpenEXR writes zeros for channels that have no slice
    state.image->writePixels(rows);
  });
}

namespace {

void put_float(const AtomicFile& file, std::uint64_t at, double number) {
  const float value = static_cast<float>(number);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  char bytes[4];
  for (int i = 0; i < 4; ++i)
    bytes[i] = static_cast<char>((bits >> (8 * i)) & 0xffu);
  const int failed = write_at(file.fd(), bytes, sizeof bytes, at);
  if (failed != 0) throw output_error(file.final_path(), "write the file", failed);
}

} // namespace

void ExrWriter::close(double render_seconds, double exposure) {
  State& state = *state_;
  state.image.reset(); // writes the line table and swallows errors: the stream remembers them
  state.stream.check();
  put_float(state.file, state.render_time_at, render_seconds);
  if (state.exposure_at) put_float(state.file, *state.exposure_at, exposure);
}

void ExrWriter::read_rows(const std::vector<std::string>& channels,
                          const std::function<void(const float* row)>& take) const {
  const State& state = *state_;
  constexpr int rows_at_once = 16; // a block of the compression
  const PixelWindow& window = state.window;
  const auto width = static_cast<std::size_t>(window.x1 - window.x0);
  std::vector<float> rows(rows_at_once * width * channels.size());
  guarded(state.file.final_path(), [&] {
    FdInput stream(state.file);
    Imf::InputFile image(stream);
    for (int y = window.y0; y < window.y1; y += rows_at_once) {
      const int last = std::min(y + rows_at_once, window.y1) - 1;
      Imf::FrameBuffer pixels;
      for (std::size_t c = 0; c < channels.size(); ++c)
        pixels.insert(channels[c],
                      Imf::Slice::Make(Imf::FLOAT, rows.data() + c * width, {window.x0, y}, width, last - y + 1,
                                       sizeof(float), sizeof(float) * width * channels.size()));
      image.setFrameBuffer(pixels);
      image.readPixels(y, last);
      for (int row = 0; row <= last - y; ++row)
        take(rows.data() + static_cast<std::size_t>(row) * width * channels.size());
    }
  });
}

void ExrWriter::commit() {
  state_->file.commit();
}

} // namespace pointgi
