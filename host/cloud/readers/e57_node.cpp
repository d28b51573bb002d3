#include "host/cloud/readers/e57_node.h"
#include <charconv>
#include <cmath>

namespace pointgi {

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

template <class Number>
Number parse(const E57File& file, const std::string& what, std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  Number value{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(static_cast<double>(value)))
    file.fail(file.xml_begin(), quoted_bytes(what) + " of the description (XML) is " + quoted_bytes(text) +
                                    ", expected a number; the file is corrupt");
  return value;
}

} // namespace

std::string e57_type(const XmlNode& node) {
  const std::string* type = node.attribute("type");
  return type == nullptr ? std::string() : *type;
}

std::int64_t e57_integer(const E57File& file, const XmlNode& node, const char* attribute, std::int64_t otherwise) {
  const std::string* text = node.attribute(attribute);
  return text == nullptr ? otherwise : parse<std::int64_t>(file, attribute, *text);
}

double e57_real(const E57File& file, const XmlNode& node, const char* attribute, double otherwise) {
  const std::string* text = node.attribute(attribute);
  return text == nullptr ? otherwise : parse<double>(file, attribute, *text);
}

double e57_number(const E57File& file, const XmlNode& structure, const char* name, double otherwise) {
  const XmlNode* child = structure.child(name);
  if (child == nullptr) return otherwise;
  const double value = trimmed(child->text).empty() ? 0.0 : parse<double>(file, name, child->text);
  if (e57_type(*child) != "ScaledInteger") return value;
  const double scaled = value * e57_real(file, *child, "scale", 1.0) + e57_real(file, *child, "offset", 0.0);
  if (!std::isfinite(scaled))
    file.fail(file.xml_begin(), quoted_bytes(name) + " of the description (XML) is no finite number");
  return scaled;
}

Eigen::Isometry3d e57_pose(const E57File& file, const XmlNode& scan) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const XmlNode* node = scan.child("pose");
  if (node == nullptr) return pose;
  if (const XmlNode* move = node->child("translation"))
    pose.translation() = Eigen::Vector3d(e57_number(file, *move, "x", 0.0), e57_number(file, *move, "y", 0.0),
                                         e57_number(file, *move, "z", 0.0));
  if (const XmlNode* turn = node->child("rotation")) {
    Eigen::Quaterniond rotation(e57_number(file, *turn, "w", 1.0), e57_number(file, *turn, "x", 0.0),
                                e57_number(file, *turn, "y", 0.0), e57_number(file, *turn, "z", 0.0));
    if (std::isnormal(rotation.norm())) pose.linear() = rotation.normalized().toRotationMatrix();
  }
  return pose;
}

} // namespace pointgi
