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
  for (const double bad : {0.0, -0.0, -1.0, infinity, -infinity, nan_value})
    CHECK_THROWS_AS(require_positive("a", bad, "m"), SettingError);
  CHECK(refusal([] { require_positive("Scanner::pulse_rate", -5, "Hz"); }) ==
        "Scanner::pulse_rate is -5 Hz, but must be finite and greater than 0");
}

TEST_CASE("what must not be negative may be zero") {
  for (const double good : {0.0, 1e-300, 1e300}) CHECK_NOTHROW(require_not_negative("a", good, "m"));
  for (const double bad : {-1e-300, infinity, -infinity, nan_value})
    CHECK_THROWS_AS(require_not_negative("a", bad, "m"), SettingError);
  CHECK(refusal([] { require_not_negative("Mount::lever", -0.5, "m"); }) ==
        "Mount::lever is -0.5 m, but must be finite and at least 0");
}

TEST_CASE("what must be finite may have either sign") {
  for (const double good : {0.0, -1e300, 1e300}) CHECK_NOTHROW(require_finite("a", good, "m"));
  for (const double bad : {infinity, -infinity, nan_value})
    CHECK_THROWS_AS(require_finite("a", bad, "m"), SettingError);
  CHECK(refusal([] { require_finite("Tripod::height", infinity, "m"); }) ==
        "Tripod::height is inf m, but must be finite");
}

TEST_CASE("what must lie within an interval may lie on its ends") {
  for (const double good : {0.0, 0.5, 1.0}) CHECK_NOTHROW(require_within("a", good, 0, 1, ""));
  for (const double bad : {-1e-300, 1.0000001, infinity, -infinity, nan_value})
    CHECK_THROWS_AS(require_within("a", bad, 0, 1, ""), SettingError);
  CHECK(refusal([] { require_within("Material::reflectance", 1.5, 0, 1, ""); }) ==
        "Material::reflectance is 1.5, but must be from 0 to 1");
}

TEST_CASE("an angle may be a turn to either side") {
  const double turn = 360 * (3.14159265358979323846 / 180);
  for (const double good : {0.0, turn, -turn}) CHECK_NOTHROW(require_angle("a", good));
  for (const double bad : {6.29, -6.29, infinity, -infinity, nan_value})
    CHECK_THROWS_AS(require_angle("a", bad), SettingError);
}

TEST_CASE("a message asks about the unit where the value lets one guess it") {
  CHECK(refusal([] { require_angle("a", -90); }) == "a is -90 rad, but must be from -2 pi to 2 pi: given in degrees?");
  CHECK(refusal([] { require_within("a", 45, 0, 1, "rad"); }) ==
        "a is 45 rad, but must be from 0 to 1: given in degrees?");
  CHECK(refusal([] { require_within("a", 2, 0, 1, "rad"); }) == "a is 2 rad, but must be from 0 to 1");
  CHECK(refusal([] { require_within("a", 45, 0, 1, "m"); }) == "a is 45 m, but must be from 0 to 1");
  CHECK(refusal([] { require_angle("a", nan_value); }) == "a is nan rad, but must be from -2 pi to 2 pi");
  CHECK(refusal([] { require_within("a", 1e-3, 1, 2, "Hz"); }) == "a is 0.001 Hz, but must be from 1 to 2: a period?");
  CHECK(refusal([] { require_within("a", 3, 1, 2, "Hz"); }) == "a is 3 Hz, but must be from 1 to 2");
  CHECK(refusal([] { require_rate("a", -1e-3); }) == "a is -0.001 Hz, but must be greater than 0 and at most 1e12");
}

static_assert(Validated<Asks> && !Validated<AsksNothing> && !Normalizable<Asks>);

TEST_CASE("settings that have a say are asked, and others pass as they are") {
  CHECK(validated(Asks{2}).value == 2);
  CHECK_THROWS_AS((void)validated(Asks{-2}), SettingError);
  CHECK(validated(AsksNothing{}).value == -1);
}
