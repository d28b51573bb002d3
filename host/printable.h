#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace pointgi {

/// Text from a file as an error message may show it: in quotes, other than printable ASCII as \xNN, cut after
/// `max_bytes` bytes of the text. Terminals obey escape sequences, so that nothing of a file goes there as it is.
std::string quoted_bytes(std::string_view text, std::size_t max_bytes = 40);

/// As quoted_bytes(), without the quotes.
std::string printable(std::string_view text, std::size_t max_bytes = 40);

} // namespace pointgi
