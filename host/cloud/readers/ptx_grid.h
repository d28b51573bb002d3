#pragma once
/// Where the grids of a PTX file are, before their points are read.
#include "host/cloud/readers/text_lines.h"
#include <Eigen/Core>
#include <string>
#include <vector>

namespace pointgi {

struct PtxGrid {
  std::size_t cells = 0;  ///< columns x rows: lines of the body
  std::size_t values = 0; ///< of the first of them: 3, 4 or 7
  Eigen::Matrix3d turn;   ///< world = turn * local + move
  Eigen::Vector3d move;
  Eigen::Vector3d station;    ///< in the world
  bool transposed = false;    ///< the matrix was one for column vectors
  std::size_t first_line = 0; ///< of the body
  TextPiece body;
};

constexpr std::size_t ptx_header_lines = 10;

/// Parses the header that begins with `lines`' next line, up to its last line. Throws Error(input) with the line.
PtxGrid parse_ptx_header(TextLines& lines, const std::string& file);

/// All grids of the text, their bodies found but not read. Throws Error(input) with the line where a header is none or
/// the text ends before the last line that a header announces.
std::vector<PtxGrid> find_ptx_grids(const char* begin, const char* end, const std::string& file);

} // namespace pointgi
