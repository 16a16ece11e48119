// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_FORMULA_HPP
#define PULSECAST_HELIOS_DETAIL_FORMULA_HPP

#include <numbers>
#include <vector>

#include <pulsecast/base/text.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Formula of one variable, as in `0.01*sin(2*t)`, of numbers, `pi`, `e`, parentheses, `exp ln sqrt abs cos sin tan
/// acos asin atan cosh sinh tanh atan2(y, x)` [rad], and left-associative `+ - * / ^` in their usual precedence.
class Formula {
 public:
  /// At most 10,000 characters, parentheses 100 deep. @throws std::invalid_argument with position
  Formula(std::string_view text, std::string_view variable) : text_(text), variable_(variable) {
    if (text.size() > 10'000) fail("is longer than 10000 characters");
    sum(0);
    skip();
    if (at_ != text_.size()) fail("has unexpected text");
    text_ = variable_ = {};
  }

  [[nodiscard]] double operator()(double value) const noexcept {
    std::array<double, depth> stack{};
    std::size_t n = 0;
    for (const Step& s : steps_) {
      if (s.unary != nullptr) {
        stack[n - 1] = s.unary(stack[n - 1]);
      } else if (s.binary != nullptr) {
        --n;
        stack[n - 1] = s.binary(stack[n - 1], stack[n]);
      } else {
        stack[n++] = s.number.value_or(value);
      }
    }
    return stack[0];
  }

 private:
  static constexpr std::size_t depth = 256;  ///< size of the evaluation stack

  /// A function, or a number; without either the variable.
  struct Step {
    double (*unary)(double) = nullptr;
    double (*binary)(double, double) = nullptr;
    std::optional<double> number{};
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument(
        text::joined({"formula '", text_.substr(0, 80), "' ", what, " at character ", std::to_string(at_ + 1)}));
  }

  void push(std::optional<double> number) {
    if (++height_ > depth) fail("is nested too deeply");
    steps_.push_back({.number = number});
  }
  void apply(double (*unary)(double)) { steps_.push_back({.unary = unary}); }
  void apply(double (*binary)(double, double)) {
    --height_;
    steps_.push_back({.binary = binary});
  }
  void negate() {
    apply([](double x) { return -x; });
  }

  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }

  /// Takes one of several characters; 0 if another one follows.
  char take_any(std::string_view chars) {
    skip();
    return at_ < text_.size() && chars.find(text_[at_]) != chars.npos ? text_[at_++] : '\0';
  }
  bool take(char c) { return take_any({&c, 1}) != '\0'; }

  void sum(int deep) {
    if (deep > 100) fail("is nested too deeply");
    product(deep);
    while (const char sign = take_any("+-")) {
      product(deep);
      apply(sign == '+' ? +[](double a, double b) { return a + b; } : +[](double a, double b) { return a - b; });
    }
  }

  void product(int deep) {
    signed_power(deep);
    while (const char sign = take_any("*/")) {
      signed_power(deep);
      apply(sign == '*' ? +[](double a, double b) { return a * b; } : +[](double a, double b) { return a / b; });
    }
  }

  void signed_power(int deep) {
    bool negative = false;
    while (const char sign = take_any("+-")) negative ^= sign == '-';
    value(deep);
    while (take('^')) {
      const bool minus = take('-');
      value(deep);
      if (minus) negate();
      apply([](double a, double b) { return std::pow(a, b); });
    }
    if (negative) negate();
  }

  void value(int deep) {
    skip();
    if (take('(')) {
      sum(deep + 1);
      if (!take(')')) fail("lacks a closing parenthesis");
      return;
    }
    constexpr std::string_view digits = "0123456789",
                               letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
    std::string_view rest = text_.substr(at_);
    const std::size_t digit = rest.find_first_not_of('.');
    if (digit < 2 && digits.find(rest[digit]) != digits.npos) {
      const auto number = text::take_number<double>(rest, std::chars_format::fixed);
      if (!number) fail("has a number out of range");
      at_ = text_.size() - rest.size();
      return push(number);
    }
    const std::string_view name = rest.substr(0, rest.find_first_not_of(letters));
    if (name.empty()) fail("lacks a number, the variable or a function");
    const bool is_pi = name == "pi";
    if (name != variable_ && !is_pi && name != "e") return call(name, deep);
    at_ += name.size();
    push(name == variable_ ? std::nullopt : std::optional(is_pi ? std::numbers::pi : std::numbers::e));
  }

  void call(std::string_view name, int deep) {
    using Function = double (*)(double);
    static constexpr std::array<std::pair<std::string_view, Function>, 14> functions{
        {{"exp", [](double x) { return std::exp(x); }},
         {"ln", [](double x) { return std::log(x); }},
         {"sqrt", [](double x) { return std::sqrt(x); }},
         {"abs", [](double x) { return std::fabs(x); }},
         {"cos", [](double x) { return std::cos(x); }},
         {"sin", [](double x) { return std::sin(x); }},
         {"tan", [](double x) { return std::tan(x); }},
         {"acos", [](double x) { return std::acos(x); }},
         {"asin", [](double x) { return std::asin(x); }},
         {"atan", [](double x) { return std::atan(x); }},
         {"cosh", [](double x) { return std::cosh(x); }},
         {"sinh", [](double x) { return std::sinh(x); }},
         {"tanh", [](double x) { return std::tanh(x); }},
         {"atan2", nullptr}}};
    const auto named = [&](const auto& function) { return function.first == name; };
    const auto function = std::find_if(functions.begin(), functions.end(), named);
    if (function == functions.end()) fail("has the unknown word '" + std::string(name) + "'");
    at_ += name.size();
    if (!take('(')) fail("lacks the argument of the function");
    sum(deep + 1);
    if (function->second != nullptr) {
      apply(function->second);
    } else {
      if (!take(',')) fail("lacks the second argument of atan2");
      sum(deep + 1);
      apply([](double y, double x) { return std::atan2(y, x); });
    }
    if (!take(')')) fail("lacks a closing parenthesis");
  }

  std::string_view text_, variable_;  // views for the parser; empty afterwards
  std::size_t at_ = 0, height_ = 0;
  std::vector<Step> steps_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
