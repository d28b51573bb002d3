#pragma once
/// What the fuzz targets share. A target gives the bytes that libFuzzer makes to one reader: what the reader promises
/// not to do for any bytes ends the program, and libFuzzer keeps the bytes.
#include "host/error.h"
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace pointgi::test {

/// Ends the program with the words of a broken promise (tests/support/promises.h); goes on where they are empty.
void require_kept(const std::string& broken);

/// A folder of this process's own, in memory where the system has such a place; gone with the process unless that
/// crashes. POINTGI_CACHE_DIR is below it.
const std::string& scratch_folder();

/// Writes the file NAME of scratch_folder() and returns its path. Readers take files, and one name does for all.
std::string write_input(const std::string& name, std::string_view bytes);

inline std::string_view view_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The most that the heap held at once since reset_peak(), of malloc as of operator new, and what it holds now.
std::size_t peak_bytes();
std::size_t allocated_bytes();
void reset_peak();

} // namespace pointgi::test
