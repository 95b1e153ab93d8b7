#include "harness/scenario/yaml_tree.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <unordered_set>
#include <utility>
#include <vector>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "harness/errors.hpp"
#include "harness/text/text_encoding.hpp"

namespace qsmpc::harness {
namespace {

int line_of(const YAML::Mark& mark) { return mark.line >= 0 ? mark.line + 1 : 0; }

constexpr const char* kColon = "a colon after the key";

/// The lines of a text, for locating a missing colon: the parser reports the error only at the next
/// line.
class YamlLines {
 public:
  explicit YamlLines(const std::string& text) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
      const std::size_t comment = line.starts_with('#') ? 0 : line.find(" #");
      line.resize(std::min(comment, line.size()));
      line.resize(line.find_last_not_of(" \r") + 1);
      lines_.push_back(std::move(line));
    }
  }

  /// Whether line `number`, from 1, consists of plain words, so that it could be a key without its
  /// colon.
  [[nodiscard]] bool lacks_colon(int number) const {
    if (number < 1 || number > std::ssize(lines_)) return false;
    const std::string& line = at(number);
    const std::size_t begin = line.find_first_not_of(' ');
    constexpr const char* kOther = "-[]{},\"'|>%&*!@`?:";
    return begin != std::string::npos && line.find_first_of(kOther) == std::string::npos;
  }

  /// The line without a colon that caused the parser's error at line `number`; 0 if none did.
  [[nodiscard]] int culprit(int number) const {
    if (lacks_colon(number)) return number;
    const int before = filled_before(number);
    if (!lacks_colon(before)) return 0;
    // Excludes a multi-line text, which continues at a deeper indent.
    const std::size_t indent = indent_of(before);
    return indent == indent_of(number) || indent == indent_of(filled_before(before)) ? before : 0;
  }

  [[nodiscard]] std::string words(int number) const {
    return "\"" + at(number).substr(indent_of(number)) + "\"";
  }

 private:
  [[nodiscard]] const std::string& at(int number) const {
    return lines_[static_cast<std::size_t>(number) - 1];
  }
  [[nodiscard]] std::size_t indent_of(int number) const {
    if (number < 1 || number > std::ssize(lines_)) return std::string::npos;
    return at(number).find_first_not_of(' ');
  }
  [[nodiscard]] int filled_before(int number) const {
    int before = std::min(number, static_cast<int>(std::ssize(lines_)) + 1) - 1;
    while (before > 0 && at(before).empty()) --before;
    return before;
  }

  std::vector<std::string> lines_;  // without comments and trailing blanks
};

// Builds the tree from the parser's events. yaml-cpp's own nodes are not used: they resolve
// aliases, recurse without a limit of ours and do not keep the line of a missing value.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string file, const YamlLines& lines) : file_(std::move(file)), lines_(lines) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ > 0) fail(line_of(mark), "", "a second document", "one YAML document");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    // To the parser, a last line without a colon is a key without a value.
    if (!open_.empty() && lines_.lacks_colon(open_.back().key_line)) {
      fail(open_.back().key_line, "", lines_.words(open_.back().key_line), kColon);
    }
    place(YamlNode{.line = line_of(mark)});
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    fail(line_of(mark), path(), "an alias (*)", "the value itself");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    if (!open_.empty() && open_.back().node.kind == YamlNode::Kind::kMap && !open_.back().has_key) {
      take_key(mark, value);
      return;
    }
    place(YamlNode{
        .kind = YamlNode::Kind::kText, .text = value, .quoted = tag == "!", .line = line_of(mark)});
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    start(mark, tag, anchor, YamlNode::Kind::kList);
  }
  void OnSequenceEnd() override { finish(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    start(mark, tag, anchor, YamlNode::Kind::kMap);
  }
  void OnMapEnd() override { finish(); }

  [[nodiscard]] bool has_root() const { return has_root_; }
  [[nodiscard]] YamlNode take_root() { return std::move(root_); }

 private:
  struct Open {
    YamlNode node;
    bool has_key = false;  // whether the last key still lacks its value
    int key_line = 0;      // of the last key
    std::unordered_set<std::string> seen{};
  };

  [[noreturn]] void fail(int line, std::string key, std::string found, std::string expected) const {
    throw InputError({file_, line, std::move(key), std::move(found), std::move(expected)});
  }

  [[nodiscard]] std::string path() const {
    std::string text;
    for (const Open& open : open_) {
      const bool is_map = open.node.kind == YamlNode::Kind::kMap;
      if (is_map && !open.has_key) continue;
      if (!text.empty()) text += '.';
      text += is_map ? open.node.keys.back() : std::to_string(open.node.items.size());
    }
    return text;
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor != YAML::NullAnchor) fail(line_of(mark), path(), "an anchor (&)", "plain values");
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    const bool plain = tag.empty() || tag == "?" || tag == "!";
    if (!plain) fail(line_of(mark), path(), "the tag " + tag, "values without tags");
  }

  void refuse_structured_key(const YAML::Mark& mark) const {
    if (!open_.empty() && open_.back().node.kind == YamlNode::Kind::kMap && !open_.back().has_key) {
      fail(line_of(mark), path(), "a list or mapping as a key, or a bracket not closed",
           "a name as a key");
    }
  }

  void take_key(const YAML::Mark& mark, const std::string& key) {
    Open& open = open_.back();
    open.node.keys.push_back(key);
    open.has_key = true;
    open.key_line = line_of(mark);
    if (!open.seen.insert(key).second) {
      fail(line_of(mark), path(), "the key a second time", "each key once");
    }
  }

  void start(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
             YamlNode::Kind kind) {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    refuse_structured_key(mark);
    if (open_.size() >= kMaxYamlDepth) {
      fail(line_of(mark), path(), "deeper nesting",
           "at most " + std::to_string(kMaxYamlDepth) + " levels");
    }
    open_.push_back({.node = YamlNode{.kind = kind, .line = line_of(mark)}});
  }

  void finish() {
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    place(std::move(node));
  }

  void place(YamlNode node) {
    if (open_.empty()) {
      root_ = std::move(node);
      has_root_ = true;
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == YamlNode::Kind::kMap && !parent.has_key) {
      fail(node.line, path(), "an empty key", "a name as a key");
    }
    node.key_line = parent.has_key ? parent.key_line : 0;
    parent.node.items.push_back(std::move(node));
    parent.has_key = false;
  }

  std::string file_;
  const YamlLines& lines_;
  int documents_ = 0;
  bool has_root_ = false;
  YamlNode root_;
  std::vector<Open> open_;
};

void check_text(const std::string& text, const std::string& file) {
  if (text.size() > kMaxYamlBytes) {
    throw InputError({.file = file,
                      .found = std::to_string(text.size()) + " bytes",
                      .expected = "at most " + std::to_string(kMaxYamlBytes) + " bytes (1 MiB)"});
  }
  if (const auto problem = find_text_problem(text)) {
    throw InputError({.file = file,
                      .line = problem->line,
                      .found = problem->found,
                      .expected = "a YAML file in UTF-8"});
  }
}

}  // namespace

const YamlNode* YamlNode::find(std::string_view key) const {
  const auto at = std::find(keys.begin(), keys.end(), key);
  return at == keys.end() ? nullptr : &items[static_cast<std::size_t>(at - keys.begin())];
}

YamlNode* YamlNode::find(std::string_view key) {
  const auto at = std::find(keys.begin(), keys.end(), key);
  return at == keys.end() ? nullptr : &items[static_cast<std::size_t>(at - keys.begin())];
}

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      return "nothing";
    case YamlNode::Kind::kText:
      return node.quoted || node.text.empty() ? "\"" + node.text + "\"" : node.text;
    case YamlNode::Kind::kList:
      return "a list of " + std::to_string(node.items.size());
    case YamlNode::Kind::kMap:
      return "a mapping";
  }
  return "";
}

YamlNode parse_yaml(const std::string& text, const std::string& file) {
  check_text(text, file);
  const YamlLines lines(text);
  TreeBuilder builder(file, lines);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& error) {
    if (const int line = lines.culprit(line_of(error.mark)); line > 0) {
      throw InputError(
          {.file = file, .line = line, .found = lines.words(line), .expected = kColon});
    }
    throw InputError({.file = file,
                      .line = line_of(error.mark),
                      .found = "text that is not YAML (" + error.msg + ")",
                      .expected = "YAML"});
  }
  if (!builder.has_root()) {
    throw InputError({.file = file, .found = "an empty text", .expected = "YAML"});
  }
  return builder.take_root();
}

}  // namespace qsmpc::harness
