#include "raytruth/rules/wgsl.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

using std::string;
using std::string_view;

using Pair = std::pair<string_view, string_view>;

template <std::size_t N>
std::optional<string_view> other_of(const std::array<Pair, N>& pairs, string_view one) {
  for (const auto& [first, second] : pairs)
    if (first == one) return second;
  return std::nullopt;
}

template <std::size_t N>
bool contains(const std::array<string_view, N>& words, string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::array types{Pair{"real", "f32"},  Pair{"float", "f32"}, Pair{"vec4", "vec4f"},
                           Pair{"bool", "bool"}, Pair{"int", "i32"},   Pair{"uint", "u32"}};

// Functions that mean the same in both languages, for the types of the rules.
constexpr std::array known_functions{Pair{"abs", "abs"},
                                     Pair{"floor", "floor"},
                                     Pair{"max", "max"},
                                     Pair{"min", "min"},
                                     Pair{"sqrt", "sqrt"},
                                     Pair{"floatBitsToUint", "bitcast<u32>"},
                                     Pair{"uintBitsToFloat", "bitcast<f32>"}};

// WGSL compiles as it pleases: there is no word for "as it is written".
constexpr string_view exactness = "as_written";

// What the first text may define: words that are translated here.
constexpr std::array known_macros{string_view("real"), exactness};

// Keywords and reserved words of WGSL, and functions that are written here, which GLSL leaves to its users.
constexpr string_view words_of_wgsl =
    " NULL Self abstract alias alignas alignof as async auto await become bitcast catch compile concept "
    "const_assert continuing crate debugger decltype delete demote diagnostic enable explicit export extends f16 "
    "f32 final finally fn friend from get groupshared handle i32 impl implements import instanceof let loop "
    "macro match meta mod module move mut mutable new nil null nullptr of operator override package pass private "
    "protected ptr pub ref register require requires select self set storage super target throw trait try type "
    "typeof u32 unless use var vec4f virtual wgsl where with workgroup yield ";

enum class TokenKind { word, integer, unsigned_integer, floating, symbol, end };

struct Token {
  TokenKind kind = TokenKind::end;
  string_view text;
  string gap;  ///< white space and comments before it
  std::size_t line = 1;
};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Cuts a text into tokens. Lines that begin with '#' are dropped.
class Lexer {
 public:
  Lexer(string_view text, string_view name) : text_(text), name_(name) {}

  std::vector<Token> tokens() {
    std::vector<Token> tokens;
    do {
      string gap = take_gap();
      Token token = next();
      if (token.kind != TokenKind::end && depth_ > 0) refuse(token.line, token.text, "no code between #if and #endif");
      token.gap = std::move(gap);
      tokens.push_back(token);
    } while (tokens.back().kind != TokenKind::end);
    return tokens;
  }

  [[noreturn]] void refuse(std::size_t line, string_view found, string_view allowed) const {
    throw InputError(fmt::format("{}: line {}: found {}; {} is allowed in what becomes WGSL", name_, line,
                                 found.empty() ? "the end" : found, allowed));
  }

 private:
  char at(std::size_t i) const { return i < text_.size() ? text_[i] : '\0'; }

  string_view rest_of_line() const { return text_.substr(place_, text_.find('\n', place_) - place_); }

  /// White space and comments, without directives.
  string take_gap() {
    string gap;
    while (place_ < text_.size()) {
      const string_view line = rest_of_line();
      if (at(place_) == '#') {
        directive(line);
        place_ += line.size() + 1;
        ++line_;
      } else if (line.starts_with("//")) {
        gap += line;
        place_ += line.size();
      } else if (std::isspace(static_cast<unsigned char>(at(place_))) != 0) {
        if (at(place_) == '\n') ++line_;
        gap += at(place_++);
      } else {
        break;
      }
    }
    return gap;
  }

  void directive(string_view line) {
    if (line.starts_with("#if ")) {
      ++depth_;
    } else if (line.starts_with("#endif")) {
      --depth_;
    } else if (line.starts_with("#define ")) {
      const string_view macro = line.substr(8, line.find_first_of(" (", 8) - 8);
      if (!contains(known_macros, macro)) refuse(line_, line, fmt::format("{}", fmt::join(known_macros, " or ")));
    } else if (!line.starts_with("#else")) {
      refuse(line_, line, "#define, #if, #else and #endif");
    }
  }

  Token next() {
    const std::size_t begin = place_;
    const auto token = [&](TokenKind kind) { return Token{kind, text_.substr(begin, place_ - begin), {}, line_}; };
    if (begin >= text_.size()) return token(TokenKind::end);
    if (is_letter(at(begin))) {
      while (is_letter(at(place_)) || is_digit(at(place_))) ++place_;
      return token(TokenKind::word);
    }
    if (is_digit(at(begin))) return token(number());
    for (const string_view symbol :
         {"<<", ">>", "==", "!=", "<=", ">=", "&&", "||", "++", "--", "+=", "-=", "*=", "/="})
      if (text_.substr(begin).starts_with(symbol)) {
        place_ += symbol.size();
        return token(TokenKind::symbol);
      }
    ++place_;
    return token(TokenKind::symbol);
  }

  TokenKind number() {
    const bool is_hexadecimal = at(place_) == '0' && at(place_ + 1) == 'x';
    if (is_hexadecimal) place_ += 2;
    bool is_floating = false;
    for (;; ++place_) {
      const char c = at(place_);
      const bool is_exponent = !is_hexadecimal && c == 'e';
      if (is_exponent && (at(place_ + 1) == '-' || at(place_ + 1) == '+')) ++place_;
      if (c == '.' || is_exponent) is_floating = true;
      if (c != '.' && !is_exponent && !is_digit(c) &&
          !(is_hexadecimal && std::isxdigit(static_cast<unsigned char>(c)) != 0))
        break;
    }
    if (is_floating) return TokenKind::floating;
    if (at(place_) != 'u') return TokenKind::integer;
    ++place_;
    return TokenKind::unsigned_integer;
  }

  string_view text_;
  string_view name_;
  std::size_t place_ = 0;
  std::size_t line_ = 1;
  int depth_ = 0;  ///< of #if
};

enum class Binding { tight, product, sum, shift, comparison, conjunction, disjunction };

/// An expression in WGSL, with the gap before it, and how its outermost operator binds.
struct Expression {
  string text;
  Binding binding = Binding::tight;
};

string indent_of(const string& text) { return text.substr(0, text.find_first_not_of(" \n")); }

string without_indent(const string& text) { return text.substr(indent_of(text).size()); }

string bracketed(const string& text) { return indent_of(text) + "(" + without_indent(text) + ")"; }

/// One pass over the tokens, a function for each thing that the subset has.
class Translator {
 public:
  Translator(string_view glsl, string_view name) : lexer_(glsl, name), tokens_(lexer_.tokens()) {}

  string text() {
    string text;
    while (token().kind != TokenKind::end) text += function();
    return text + token().gap;
  }

 private:
  [[nodiscard]] const Token& token(std::size_t ahead = 0) const {
    return tokens_[std::min(place_ + ahead, tokens_.size() - 1)];
  }
  [[nodiscard]] bool is(string_view text, std::size_t ahead = 0) const { return token(ahead).text == text; }

  const Token& take() { return tokens_[std::min(place_++, tokens_.size() - 1)]; }

  [[noreturn]] void refuse(const Token& found, string_view allowed) const {
    lexer_.refuse(found.line, found.text, allowed);
  }

  /// This symbol or word, with the gap before it.
  string expect(string_view text) {
    if (!is(text)) refuse(token(), text);
    const Token& found = take();
    return found.gap + string(text);
  }

  string_view type() {
    const auto wgsl = other_of(types, token().text);
    if (!wgsl) refuse(token(), "real, vec4, bool, int or uint");
    take();
    return *wgsl;
  }

  /// A name that is declared here, in a function or outside.
  string_view new_name() {
    const Token& found = take();
    if (found.kind != TokenKind::word || words_of_wgsl.find(fmt::format(" {} ", found.text)) != string_view::npos ||
        found.text.starts_with("__") || other_of(types, found.text) || other_of(known_functions, found.text) ||
        functions_.contains(found.text))
      refuse(found, "a new name that neither language keeps for itself");
    return found.text;
  }

  string function() {
    const string gap = token().gap;
    const string_view result = type();
    const string_view name = new_name();
    parameters_.clear();
    locals_.clear();
    string text = fmt::format("{}fn {}{}", gap, name, expect("("));
    while (!is(")")) {
      const string before = token().gap;
      const string_view parameter_type = type();
      const string_view parameter = new_name();
      if (!parameters_.insert(parameter).second) refuse(token(), "one parameter of each name");
      text += fmt::format("{}{}: {}", before, parameter, parameter_type);
      if (!is(")")) text += expect(",");
    }
    text += fmt::format("{} -> {}", expect(")"), result);
    find_assigned();
    text += block();
    functions_.insert(name);
    return text;
  }

  /// The names that are assigned to in the function whose body begins here: `name =` or `name[i] =`, without a type.
  void find_assigned() {
    assigned_.clear();
    std::size_t depth = 0;
    string_view before;
    for (std::size_t i = 0; token(i).kind != TokenKind::end; ++i) {
      if (is("{", i)) ++depth;
      if (is("}", i) && --depth == 0) return;
      const bool is_assigned = is("=", i + 1) || (is("[", i + 1) && is("=", i + 4));
      if (is_assigned && !other_of(types, before)) assigned_.insert(token(i).text);
      before = token(i).text;
    }
  }

  string block() {
    string text = expect("{");
    while (!is("}")) text += statement();
    return text + expect("}");
  }

  string statement() {
    if (is("if")) return conditional_statement();
    if (is("return")) {
      string text = expect("return");
      text += expression().text;
      return text + expect(";");
    }
    if (is(exactness) || other_of(types, token().text)) return declaration();
    return assignment();
  }

  string conditional_statement() {
    string text = expect("if");
    text += expect("(");
    text += expression().text;
    text += expect(")");
    text += is("{") ? block() : " {" + statement() + " }";
    if (is("else")) refuse(token(), "if without else");
    return text;
  }

  string declaration() {
    const string gap = token().gap;
    if (is(exactness)) take();
    const string_view declared = type();
    const Token& place = token();
    const string_view name = new_name();
    if (parameters_.contains(name) || locals_.contains(name)) refuse(place, "one thing of each name in a function");
    string text =
        fmt::format("{}{} {}: {}{}", gap, assigned_.contains(name) ? "var" : "let", name, declared, expect("="));
    text += expression().text;
    locals_.insert(name);
    return text + expect(";");
  }

  string assignment() {
    const Token& name = take();
    if (!locals_.contains(name.text))
      refuse(name, "a statement: return, if, a declaration with a value, local = or local[i] =");
    string text = name.gap + string(name.text);
    if (is("[")) text += component();
    text += expect("=");
    text += expression().text;
    return text + expect(";");
  }

  /// [i]
  string component() {
    string text = expect("[");
    if (token().kind != TokenKind::integer) refuse(token(), "a literal between [ and ]");
    text += take().text;
    return text + expect("]");
  }

  Expression expression() {
    const Expression condition = disjunction();
    if (!is("?")) return condition;
    take();
    const Expression if_true = expression();
    expect(":");
    const Expression if_false = expression();
    return {fmt::format("{}select({}, {}, {})", indent_of(condition.text), without_indent(if_false.text),
                        without_indent(if_true.text), without_indent(condition.text))};
  }

  /// WGSL wants brackets around && beside ||.
  Expression disjunction() {
    Expression left = conjunction();
    const auto operand = [](const Expression& one) {
      return one.binding == Binding::conjunction ? bracketed(one.text) : one.text;
    };
    while (is("||")) {
      const string symbol = expect("||");
      left = {operand(left) + symbol + operand(conjunction()), Binding::disjunction};
    }
    return left;
  }

  Expression conjunction() {
    Expression left = comparison();
    while (is("&&")) {
      const string symbol = expect("&&");
      left = {left.text + symbol + comparison().text, Binding::conjunction};
    }
    return left;
  }

  Expression comparison() {
    Expression left = shift();
    for (const string_view one : {"<", ">", "<=", ">=", "==", "!="}) {
      if (!is(one)) continue;
      const string symbol = expect(one);
      return {left.text + symbol + shift().text, Binding::comparison};
    }
    return left;
  }

  /// WGSL wants brackets around sums and products that are shifted, and amounts that are unsigned.
  Expression shift() {
    Expression left = sum();
    for (const string_view one : {"<<", ">>"}) {
      if (!is(one)) continue;
      const string symbol = expect(one);
      const Token& amount = take();
      if (amount.kind != TokenKind::integer && amount.kind != TokenKind::unsigned_integer) refuse(amount, "a literal");
      return {(left.binding == Binding::tight ? left.text : bracketed(left.text)) + symbol + amount.gap +
                  string(amount.text) + (amount.kind == TokenKind::integer ? "u" : ""),
              Binding::shift};
    }
    return left;
  }

  Expression sum() {
    Expression left = product();
    while (is("+") || is("-")) {
      const string symbol = expect(token().text);
      left = {left.text + symbol + product().text, Binding::sum};
    }
    return left;
  }

  Expression product() {
    Expression left = factor();
    while (is("*") || is("/")) {
      const string symbol = expect(token().text);
      left = {left.text + symbol + factor().text, Binding::product};
    }
    return left;
  }

  /// What binds tighter than operators between two.
  Expression factor() {
    if (is("-")) {
      const string symbol = expect("-");
      return {symbol + factor().text};
    }
    Expression found = primary();
    while (is("[")) found.text += component();
    return found;
  }

  Expression primary() {
    const Token& found = take();
    const string text = found.gap + string(found.text);
    if (found.kind == TokenKind::floating) return {text + "f"};  // binary32 as in GLSL, not what constants are in WGSL
    if (found.kind == TokenKind::integer || found.kind == TokenKind::unsigned_integer) return {text};
    if (found.text == "(") {
      const string inside = expression().text;
      return {text + inside + expect(")")};
    }
    if (found.kind == TokenKind::word && is("(")) return call(found);
    if (found.text == "true" || found.text == "false" || parameters_.contains(found.text) ||
        locals_.contains(found.text))
      return {text};
    refuse(found, "an expression of literals, parameters and locals");
  }

  Expression call(const Token& name) {
    std::optional<string_view> called = other_of(types, name.text);
    if (!called) called = other_of(known_functions, name.text);
    if (!called && functions_.contains(name.text)) called = name.text;
    if (!called) refuse(name, "a function that stands before, or abs, floor, max, min or sqrt");
    string text = name.gap + string(*called) + expect("(");
    while (!is(")")) {
      text += expression().text;
      if (!is(")")) text += expect(",");
    }
    return {text + expect(")")};
  }

  Lexer lexer_;
  std::vector<Token> tokens_;
  std::size_t place_ = 0;
  std::set<string_view> functions_;
  std::set<string_view> parameters_;  ///< of the function at hand, as what follows
  std::set<string_view> locals_;
  std::set<string_view> assigned_;
};

}  // namespace

string wgsl_of(string_view glsl, string_view name) { return Translator(glsl, name).text(); }

}  // namespace raytruth
