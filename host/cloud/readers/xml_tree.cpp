#include "host/cloud/readers/xml_tree.h"
#include "host/cloud/input_file.h"
#include <algorithm>

namespace pointgi {

namespace {

constexpr int deepest = 64; // elements within elements; a description of scans has a dozen

class Parser {
public:
  Parser(std::string_view text, const std::function<void(std::size_t, const std::string&)>& fail_with)
      : text_(text), fail_with_(fail_with) {}

  XmlNode document() {
    if (take("\xef\xbb\xbf")) {
    } // some programs begin with a byte order mark
    skip_misc();
    if (!take("<")) fail("expected an element");
    return element(0);
  }

private:
  [[noreturn]] void fail(const std::string& what) const {
    fail_with_(at_, what + "; the description (XML) is corrupt");
    throw Error(ErrorKind::internal, "an XML error that nobody threw");
  }

  bool at_end() const { return at_ >= text_.size(); }
  bool take(std::string_view expected) {
    if (text_.substr(at_, expected.size()) != expected) return false;
    at_ += expected.size();
    return true;
  }
  void skip_blanks() {
    while (!at_end() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      ++at_;
  }
  std::string_view until(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string_view::npos) fail("expected " + quoted_bytes(end) + " before the end");
    const std::string_view part = text_.substr(at_, found - at_);
    at_ = found + end.size();
    return part;
  }

  /// Declarations, comments and blanks between elements.
  void skip_misc() {
    while (true) {
      skip_blanks();
      if (take("<?"))
        until("?>");
      else if (take("<!--"))
        until("-->");
      else
        return;
    }
  }

  std::string name() {
    const std::size_t begin = at_;
    while (!at_end() && std::string_view(" \t\r\n/>=<\"'").find(text_[at_]) == std::string_view::npos)
      ++at_;
    if (at_ == begin) fail("expected a name");
    return std::string(text_.substr(begin, at_ - begin));
  }

  static std::string resolved(std::string_view raw) {
    static constexpr std::pair<std::string_view, char> entities[] = {
        {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
    std::string text;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      text += raw[i];
      if (raw[i] != '&') continue;
      for (const auto& [entity, meaning] : entities)
        if (raw.substr(i, entity.size()) == entity) {
          text.back() = meaning;
          i += entity.size() - 1;
          break;
        }
    }
    return text;
  }

  /// Behind its "<".
  XmlNode element(int depth) {
    if (depth > deepest) fail("more than " + std::to_string(deepest) + " elements within each other");
    XmlNode node;
    node.name = name();
    while (true) {
      skip_blanks();
      if (take("/>")) return node;
      if (take(">")) break;
      std::string attribute = name();
      skip_blanks();
      if (!take("=")) fail("expected \"=\" behind an attribute's name");
      skip_blanks();
      const bool single = take("'");
      if (!single && !take("\"")) fail("expected an attribute's value in quotes");
      node.attributes.emplace_back(std::move(attribute), resolved(until(single ? "'" : "\"")));
    }
    content(node, depth);
    return node;
  }

  void content(XmlNode& node, int depth) {
    while (true) {
      const std::size_t tag = std::min(text_.find('<', at_), text_.size());
      node.text += resolved(text_.substr(at_, tag - at_));
      at_ = tag;
      if (take("</")) {
        if (name() != node.name) fail("the end of another element than " + quoted_bytes(node.name));
        skip_blanks();
        if (!take(">")) fail("expected \">\"");
        return;
      }
      if (take("<![CDATA["))
        node.text += until("]]>");
      else if (take("<!--"))
        until("-->");
      else if (take("<?"))
        until("?>");
      else if (take("<"))
        node.children.push_back(element(depth + 1));
      else
        fail("expected the end of " + quoted_bytes(node.name));
    }
  }

  std::string_view text_;
  const std::function<void(std::size_t, const std::string&)>& fail_with_;
  std::size_t at_ = 0;
};

} // namespace

const XmlNode* XmlNode::child(std::string_view wanted) const {
  const auto found = std::find_if(children.begin(), children.end(), [&](const XmlNode& c) { return c.name == wanted; });
  return found == children.end() ? nullptr : &*found;
}

const std::string* XmlNode::attribute(std::string_view wanted) const {
  for (const auto& [key, value] : attributes)
    if (key == wanted) return &value;
  return nullptr;
}

XmlNode parse_xml(std::string_view text, const std::function<void(std::size_t, const std::string&)>& fail) {
  return Parser(text, fail).document();
}

} // namespace pointgi
