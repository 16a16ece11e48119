// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/require.hpp>

#include <limits>
#include <string>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {

const double infinity = std::numeric_limits<double>::infinity();
const double nan_value = std::numeric_limits<double>::quiet_NaN();

/// What is said when a check refuses a value; empty if it does not.
template <class Check>
std::string refusal(Check check) {
  try {
    check();
  } catch (const SettingError& error) {
    return error.what();
  }
  return "";
}

struct Asks {
  double value = 1;
  void validate() const { require_positive("Asks::value", value, "m"); }
};
struct AsksNothing {
  double value = -1;
};

}  // namespace

TEST_CASE("what must be positive is refused at zero and below, and where it is not finite") {
  CHECK_NOTHROW(require_positive("a", 1e-300, "m"));
  for (const double bad : {0.0, -0.0, -1.0, infinity, -infinity, nan_value}) CHECK_THROWS_AS(require_positive("a", bad, "m"), SettingError);
  CHECK(refusal([] { require_positive("Scanner::pulse_rate", -5, "Hz"); }) ==
        "Scanner::pulse_rate is -5 Hz, but must be finite and greater than 0");
}

TEST_CASE("what must not be negative may be zero") {
  for (const double good : {0.0, 1e-300, 1e300}) CHECK_NOTHROW(require_not_negative("a", good, "m"));
  for (const double bad : {-1e-300, infinity, -infinity, nan_value}) CHECK_THROWS_AS(require_not_negative("a", bad, "m"), SettingError);
  CHECK(refusal([] { require_not_negative("Mount::lever", -0.5, "m"); }) == "Mount::lever is -0.5 m, but must be finite and at least 0");
}

TEST_CASE("what must be finite may have either sign") {
  for (const double good : {0.0, -1e300, 1e300}) CHECK_NOTHROW(require_finite("a", good, "m"));
  for (const double bad : {infinity, -infinity, nan_value}) CHECK_THROWS_AS(require_finite("a", bad, "m"), SettingError);
  CHECK(refusal([] { require_finite("Tripod::height", infinity, "m"); }) == "Tripod::height is inf m, but must be finite");
}

TEST_CASE("what must lie within an interval may lie on its ends") {
  for (const double good : {0.0, 0.5, 1.0}) CHECK_NOTHROW(require_within("a", good, 0, 1, ""));
  for (const double bad : {-1e-300, 1.0000001, infinity, -infinity, nan_value})
    CHECK_THROWS_AS(require_within("a", bad, 0, 1, ""), SettingError);
  CHECK(refusal([] { require_within("Material::reflectance", 1.5, 0, 1, ""); }) == "Material::reflectance is 1.5, but must be from 0 to 1");
}

TEST_CASE("settings that have a say are asked, and others pass as they are") {
  CHECK(validated(Asks{2}).value == 2);
  CHECK_THROWS_AS((void)validated(Asks{-2}), SettingError);
  CHECK(validated(AsksNothing{}).value == -1);
}
