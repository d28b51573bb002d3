#include "host/image/png_writer.h"
#include "host/atomic_file.h"
#include "host/error.h"
#include "host/image/srgb.h"
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <exception>
#include <new>
#include <png.h>

namespace pointgi {

std::uint8_t display_byte(float radiance, float scale) {
  const float linear = radiance * scale;
  if (!(linear > 0.0f)) return 0; // negative and NaN
  if (linear >= 1.0f) return 255;
  return static_cast<std::uint8_t>(std::lround(255.0f * linear_to_srgb(linear)));
}

/// libpng reports errors by longjmp, which runs no destructors, and C++ exceptions must not cross its C frames. So our
/// callbacks keep exceptions here, and what is called between setjmp and longjmp holds only plain data.
struct PngWriter::State {
  explicit State(const std::string& path) : file(path) {}
  ~State() { png_destroy_write_struct(&png, &info); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  static void on_error(png_structp png, png_const_charp text) {
    State& state = *static_cast<State*>(png_get_error_ptr(png));
    std::snprintf(state.message, sizeof state.message, "%s", text);
    png_longjmp(png, 1);
  }

  static void on_warning(png_structp, png_const_charp) {}

  static void on_write(png_structp png, png_bytep bytes, std::size_t count) {
    if (!static_cast<State*>(png_get_io_ptr(png))->try_write(bytes, count)) png_error(png, "write failed");
  }

  static void on_flush(png_structp) {}

  bool try_write(const void* bytes, std::size_t count) noexcept {
    try {
      file.write(bytes, count);
      return true;
    } catch (...) {
      write_error = std::current_exception();
      return false;
    }
  }

  /// Runs calls into libpng; throws what our own write threw, or else what libpng said.
  template <class Calls>
  void guarded(Calls calls) {
    if (setjmp(png_jmpbuf(png)) == 0) {
      calls();
      return;
    }
    if (write_error) std::rethrow_exception(write_error);
    throw Error(ErrorKind::output,
                file.final_path() + ": libpng cannot write the file: " + message + "; check the folder and the disk");
  }

  AtomicFile file;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::exception_ptr write_error;
  char message[256] = "";
};

PngWriter::PngWriter(const std::string& path, int width, int height) : state_(std::make_unique<State>(path)) {
  State& state = *state_;
  state.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, State::on_error, State::on_warning);
  if (state.png == nullptr) throw std::bad_alloc();
  state.info = png_create_info_struct(state.png);
  if (state.info == nullptr) throw std::bad_alloc();
  state.guarded([&state, width, height] {
    png_set_write_fn(state.png, &state, State::on_write, State::on_flush);
    // libpng refuses more than 1e6 rows or columns unless told otherwise: a guard for readers, not for us.
    png_set_user_limits(state.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(state.png, state.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(state.png, state.info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(state.png, state.info);
  });
}

PngWriter::~PngWriter() = default;

void PngWriter::write_row(const std::uint8_t* rgb) {
  State& state = *state_;
  state.guarded([&state, rgb] { png_write_row(state.png, rgb); });
}

void PngWriter::close() {
  State& state = *state_;
  state.guarded([&state] { png_write_end(state.png, nullptr); });
}

void PngWriter::commit() {
  state_->file.commit();
}

} // namespace pointgi
