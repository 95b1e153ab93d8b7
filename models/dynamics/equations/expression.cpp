#include "models/dynamics/equations/expression.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace qsmpc::models {
namespace {

// Far more than in any real formula, and safe for the stack.
constexpr int kDeepest = 200;
constexpr std::size_t kLongest = 10000;  // bytes

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
/// Whether a byte begins a character of UTF-8.
bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

std::vector<std::string> known_functions() {
  std::vector<std::string> names;
  for (const ExpressionFunction& function : expression_functions())
    names.emplace_back(function.name);
  return names;
}

std::string one_of(const std::vector<std::string>& known) {
  std::string names;
  for (const std::string& name : known) names += (names.empty() ? "one of " : ", ") + name;
  return names;
}

std::string message(std::size_t column, const std::string& found, const std::string& expected) {
  const std::string place = column > 0 ? "column " + std::to_string(column) + ": " : "";
  return place + "found " + found + ", expected " + expected;
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Expression parse() {
    if (text_.size() > kLongest) {
      throw ExpressionError(0, std::to_string(text_.size()) + " bytes",
                            "a formula of at most " + std::to_string(kLongest) + " bytes");
    }
    sum();
    skip_space();
    if (at_ < text_.size()) refuse("an operator or the end");
    return std::move(result_);
  }

 private:
  using Kind = Expression::Kind;

  [[noreturn]] void refuse(const std::string& expected) {
    skip_space();
    std::string found = "the end";
    if (at_ < text_.size()) {
      std::size_t end = at_ + 1;
      if (is_letter(text_[at_]) || is_digit(text_[at_])) {
        while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
      }
      while (end < text_.size() && !begins_character(text_[end])) ++end;
      found = "'" + std::string(text_.substr(at_, end - at_)) + "'";
    }
    throw ExpressionError(column_of(at_), found, expected);
  }

  [[nodiscard]] std::size_t column_of(std::size_t at) const {
    const std::string_view before = text_.substr(0, at);
    return 1 + static_cast<std::size_t>(std::ranges::count_if(before, begins_character));
  }

  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }

  /// Whether `symbol` comes next; if so, skips it.
  bool take(std::string_view symbol) {
    skip_space();
    if (!text_.substr(at_).starts_with(symbol)) return false;
    // "*" must not match the first half of "**".
    if (symbol == "*" && text_.substr(at_).starts_with("**")) return false;
    at_ += symbol.size();
    return true;
  }

  void add(Kind kind, std::size_t from, double number = 0.0, std::string name = {}) {
    result_.steps.push_back(
        {.kind = kind, .number = number, .name = std::move(name), .column = column_of(from)});
  }

  void sum() {
    product();
    while (true) {
      skip_space();
      const std::size_t from = at_;
      if (take("+")) {
        product();
        add(Kind::kAdd, from);
      } else if (take("-")) {
        product();
        add(Kind::kSubtract, from);
      } else {
        return;
      }
    }
  }

  void product() {
    signed_power();
    while (true) {
      skip_space();
      const std::size_t from = at_;
      if (take("*")) {
        signed_power();
        add(Kind::kMultiply, from);
      } else if (take("/")) {
        signed_power();
        add(Kind::kDivide, from);
      } else {
        return;
      }
    }
  }

  void signed_power() {
    skip_space();
    if (++depth_ > kDeepest) refuse("less deeply nested formulas");
    const std::size_t from = at_;
    if (take("-")) {
      signed_power();
      add(Kind::kNegate, from);
    } else if (take("+")) {
      signed_power();
    } else {
      power();
    }
    --depth_;
  }

  void power() {
    primary();
    skip_space();
    const std::size_t from = at_;
    if (take("^") || take("**")) {
      signed_power();
      add(Kind::kPower, from);
    }
  }

  void primary() {
    skip_space();
    if (at_ == text_.size()) refuse("a number, a name or '('");
    const std::size_t from = at_;
    if (take("(")) {
      sum();
      if (!take(")")) refuse("')'");
    } else if (is_digit(text_[at_]) || text_[at_] == '.') {
      number();
    } else if (is_letter(text_[at_])) {
      while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
      const std::string name(text_.substr(from, at_ - from));
      if (take("(")) {
        call(name, from);
      } else {
        add(Kind::kName, from, 0.0, name);
      }
    } else {
      refuse("a number, a name or '('");
    }
  }

  void number() {
    double value = 0.0;
    const char* const begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (error != std::errc() || !std::isfinite(value)) refuse("a number");
    const std::size_t from = at_;
    at_ += static_cast<std::size_t>(end - begin);
    if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '.')) {
      refuse("an operator between a number and what follows");
    }
    add(Kind::kNumber, from, value);
  }

  void call(const std::string& name, std::size_t from) {
    const auto& functions = expression_functions();
    const auto function = std::ranges::find_if(
        functions, [&](const ExpressionFunction& known) { return name == known.name; });
    if (function == functions.end()) {
      throw ExpressionError(column_of(from), "the function '" + name + "'", name,
                            known_functions());
    }
    int arguments = 0;
    if (!take(")")) {
      do {
        sum();
        ++arguments;
      } while (take(","));
      if (!take(")")) refuse("',' or ')'");
    }
    if (arguments != function->arguments) {
      throw ExpressionError(column_of(from), name + " of " + std::to_string(arguments),
                            name + " of " + std::to_string(function->arguments) +
                                (function->arguments == 1 ? " argument" : " arguments"));
    }
    add(Kind::kCall, from, 0.0, name);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Expression result_;
};

}  // namespace

ExpressionError::ExpressionError(std::size_t column, const std::string& found,
                                 const std::string& expected)
    : std::invalid_argument(message(column, found, expected)),
      column_(column),
      found_(found),
      expected_(expected) {}

ExpressionError::ExpressionError(std::size_t column, const std::string& found, std::string unknown,
                                 std::vector<std::string> known)
    : ExpressionError(column, found, one_of(known)) {
  unknown_ = std::move(unknown);
  known_ = std::move(known);
}

const std::vector<ExpressionFunction>& expression_functions() {
  static const std::vector<ExpressionFunction> functions = {
      {"abs", 1},  {"acos", 1}, {"asin", 1}, {"atan", 1}, {"atan2", 2}, {"cos", 1},
      {"cosh", 1}, {"exp", 1},  {"log", 1},  {"max", 2},  {"min", 2},   {"pow", 2},
      {"sin", 1},  {"sinh", 1}, {"sqrt", 1}, {"tan", 1},  {"tanh", 1}};
  return functions;
}

Expression parse_expression(std::string_view text) { return Parser(text).parse(); }

bool is_expression_name(std::string_view text) {
  return !text.empty() && is_letter(text.front()) &&
         std::ranges::all_of(text, [](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace qsmpc::models
