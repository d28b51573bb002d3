#pragma once
/// As much of XML as descriptions of scans take: elements, attributes, text, CDATA. No entities but the five of XML,
/// no definitions.
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pointgi {

struct XmlNode {
  std::string name; ///< with its prefix: "nor:normalX"
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text; ///< of the element itself, all its pieces
  std::vector<XmlNode> children;

  /// Null where there is none of this name.
  const XmlNode* child(std::string_view wanted) const;
  const std::string* attribute(std::string_view wanted) const;
};

/// The root element. `fail(byte, what)` throws: what is wrong at a byte of the text.
XmlNode parse_xml(std::string_view text, const std::function<void(std::size_t, const std::string&)>& fail);

} // namespace pointgi
