#include "host/error.h"
#include "host/image/picture_writer.h"
#include "host/printable.h"
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfStringAttribute.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <new>

namespace pointgi {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(ErrorKind::input, path + ": " + what);
}

/// Pixels are allocated before they are read, so a few bytes of damaged header must not ask for all memory. zlib cannot
/// shrink below 1/1032; small pictures may be what they like, as other codecs do better on a black one.
void check_size(const std::string& path, std::uint64_t width, std::uint64_t height, std::uint64_t channels) {
  const std::uint64_t small = std::uint64_t{256} << 20, best_ratio = 2000;
  const std::uint64_t pixels = width * height; // both below 2^32
  const std::uint64_t limit = std::max(small, std::uint64_t{std::filesystem::file_size(path)} * best_ratio);
  if (pixels > limit / sizeof(float) / std::max<std::uint64_t>(channels, 1))
    refuse(path, "the header promises " + std::to_string(width) + "x" + std::to_string(height) + " pixels in " +
                     std::to_string(channels) +
                     " channels, more than a file of this size can hold; it is damaged, render or copy it again");
}

void read_matrix(const Imf::Header& header, const char* name, std::array<float, 16>& out) {
  const auto* matrix = header.findTypedAttribute<Imf::M44fAttribute>(name);
  if (matrix == nullptr) return;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = matrix->value().getValue()[i];
}

PictureAttributes read_attributes(const Imf::Header& header) {
  PictureAttributes attributes;
  for (auto i = header.begin(); i != header.end(); ++i) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
      attributes.text[i.name()] = text->value();
    else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&i.attribute()))
      attributes.number[i.name()] = static_cast<double>(real->value());
    else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&i.attribute()))
      attributes.number[i.name()] = integer->value();
  }
  read_matrix(header, "worldToCamera", attributes.world_to_camera);
  read_matrix(header, "worldToNDC", attributes.world_to_ndc);
  return attributes;
}

Picture read(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imf::Header& header = file.header();
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  const Imf::ChannelList& channels = header.channels();

  std::uint64_t channel_count = 0;
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    ++channel_count;
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      refuse(path,
             "channel " + quoted_bytes(c.name()) +
                 " has fewer samples than pixels (luminance and chroma), expected one a pixel; convert it to RGB");
  }
  // OpenEXR keeps windows within half the range of int, so these differences cannot overflow.
  const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
  check_size(path, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), channel_count);

  Picture picture;
  picture.width = width;
  picture.height = height;
  picture.full_width = display.max.x - display.min.x + 1;
  picture.full_height = display.max.y - display.min.y + 1;
  picture.window.x0 = data.min.x - display.min.x;
  picture.window.x1 = picture.window.x0 + width;
  picture.window.y0 = data.min.y - display.min.y;
  picture.window.y1 = picture.window.y0 + height;
  picture.attributes = read_attributes(header);

  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  Imf::FrameBuffer pixels;
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    const bool is_uint = c.channel().type == Imf::UINT;
    void* values = nullptr;
    if (is_uint) {
      picture.uints[c.name()].resize(size);
      values = picture.uints[c.name()].data();
    } else {
      picture.channels[c.name()].resize(size);
      values = picture.channels[c.name()].data();
    }
    pixels.insert(c.name(), Imf::Slice::Make(is_uint ? Imf::UINT : Imf::FLOAT, values, data));
  }
  file.setFrameBuffer(pixels);
  file.readPixels(data.min.y, data.max.y);
  for (const auto& [name, ids] : picture.uints) {
    std::vector<float>& values = picture.channels[name];
    values.reserve(size);
    for (const std::uint32_t id : ids)
      values.push_back(static_cast<float>(id));
  }
  return picture;
}

bool is_png(const std::string& path) {
  char start[8] = {};
  return std::ifstream(path, std::ios::binary).read(start, sizeof start) &&
         std::equal(start, start + sizeof start, "\x89PNG\r\n\x1a\n");
}

} // namespace

Picture read_exr(const std::string& path) {
  std::error_code failed;
  const auto status = std::filesystem::status(path, failed);
  if (!std::filesystem::exists(status)) refuse(path, "no such file, expected an EXR picture; check the path");
  // Also keeps us from waiting for ever on a pipe.
  if (!std::filesystem::is_regular_file(status))
    refuse(path, "is a folder, a device or a pipe, expected an EXR picture; give a regular file");
  if (is_png(path)) refuse(path, "is a PNG, which holds no radiances; give the EXR picture that was written beside it");
  try {
    return read(path);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse(path, "cannot be read as an EXR picture: " + printable(error.what(), 300) + "; render or copy it again");
  }
}

} // namespace pointgi
