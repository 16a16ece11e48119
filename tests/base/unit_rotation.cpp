// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/unit_rotation.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {

Rotation scaled(const Rotation& r, double by) { return {by * r.w, by * r.x, by * r.y, by * r.z}; }

bool passes(const Rotation& r) {
  try {
    require_rotation("Mount::boresight", r);
    return true;
  } catch (const SettingError&) {
    return false;
  }
}

struct Turned {
  Rotation rotation = no_rotation;
  void validate() const { require_rotation("Turned::rotation", rotation); }
  void normalize() noexcept { rotation = unit(rotation); }
};
static_assert(Normalizable<Turned>);
static_assert(!Normalizable<Rotation>);

}  // namespace

TEST_CASE("a rotation of single precision, or off by less than a thousandth, passes and is made unit") {
  support::Generator any(1);
  for (int k = 0; k < 1000; ++k) {
    const Rotation exact = any.rotation();
    const Rotation rounded{static_cast<float>(exact.w), static_cast<float>(exact.x), static_cast<float>(exact.y),
                           static_cast<float>(exact.z)};
    for (const Rotation& r : {rounded, scaled(exact, any.uniform(0.9991, 1.0009))}) {
      CHECK(passes(r));
      CHECK(std::fabs(length(unit(r)) - 1) <= 1e-9);
      CHECK(std::fabs(dot(unit(r), exact)) > 1 - 2e-9);
    }
  }
}

TEST_CASE("a rotation that is unit to 1e-9 stays as it is, bit for bit") {
  support::Generator any(2);
  for (int k = 0; k < 1000; ++k) {
    const Rotation r = scaled(any.rotation(), 1 + any.uniform(-9e-10, 9e-10));
    CHECK(unit(r) == r);
    CHECK(validated(Turned{r}).rotation == r);
  }
}

TEST_CASE("a rotation off by more is refused with its field, its norm and what is allowed") {
  for (const double norm : {0.0, 0.9989, 1.0011, 1.17, 2.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    CAPTURE(norm);
    CHECK_FALSE(passes(scaled(no_rotation, norm)));
  }
  std::string said;
  try {
    require_rotation("Mount::boresight", {0, 1.5, 0, 0});
  } catch (const SettingError& error) {
    said = error.what();
  }
  CHECK(said == "Mount::boresight (norm) is 1.5, but must be from 0.999 to 1.001");
}

TEST_CASE("settings that are validated have unit rotations") {
  CHECK(length(validated(Turned{scaled(no_rotation, 1.0009)}).rotation) == support::relative(1, 1e-15));
  CHECK_THROWS_AS((void)validated(Turned{scaled(no_rotation, 1.01)}), SettingError);
}
