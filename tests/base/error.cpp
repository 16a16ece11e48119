// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/error.hpp>

#include <concepts>
#include <string>

#include <doctest/doctest.h>

using namespace pulsecast;

static_assert(std::derived_from<SettingError, std::invalid_argument>);
static_assert(std::derived_from<FileError, std::runtime_error>);

TEST_CASE("a setting error names the field, the value, the unit and what is allowed") {
  const SettingError error("Scanner::pulse_rate", -5, "Hz", "finite and greater than 0");
  CHECK(error.field() == "Scanner::pulse_rate");
  CHECK(error.value() == -5);
  CHECK(error.unit() == "Hz");
  CHECK(error.allowed() == "finite and greater than 0");
  CHECK(std::string(error.what()) == "Scanner::pulse_rate is -5 Hz, but must be finite and greater than 0");
}

TEST_CASE("a setting error without a unit leaves no gap in its sentence") {
  CHECK(std::string(SettingError("Material::reflectance", 1.5, "", "from 0 to 1").what()) ==
        "Material::reflectance is 1.5, but must be from 0 to 1");
}

TEST_CASE("a file error names the path, the place and the problem") {
  const FileError error("roof.obj", "line 12", "a face needs three corners");
  CHECK(error.path() == "roof.obj");
  CHECK(error.place() == "line 12");
  CHECK(error.problem() == "a face needs three corners");
  CHECK(std::string(error.what()) == "roof.obj, line 12: a face needs three corners");
}

TEST_CASE("a file error about a file as a whole names no place") {
  CHECK(std::string(FileError("roof.obj", "", "no such file").what()) == "roof.obj: no such file");
}

TEST_CASE("a setting error gets the name of what the setting belongs to, once") {
  const auto refused = [] {
    return naming("leg 3", []() -> int { throw SettingError("Scanner::pulse_rate", -5, "Hz", "at least 0"); });
  };
  CHECK_THROWS_WITH_AS(refused(), "leg 3: Scanner::pulse_rate is -5 Hz, but must be at least 0", SettingError);
  CHECK_THROWS_WITH_AS(naming("leg 3", refused), "leg 3: Scanner::pulse_rate is -5 Hz, but must be at least 0",
                       SettingError);
  const auto told = [] { return naming("leg 3", []() -> int { throw SettingError("tEnd", " is not after tStart"); }); };
  CHECK_THROWS_WITH_AS(naming("a.xml", told), "a.xml: leg 3: tEnd is not after tStart", SettingError);
  CHECK_THROWS_WITH_AS(naming("a.xml", refused), "a.xml: leg 3: Scanner::pulse_rate is -5 Hz, but must be at least 0",
                       SettingError);
  CHECK_THROWS_WITH_AS(naming("a.xml", [] { throw FileError("b.obj", "", "no such file"); }), "b.obj: no such file",
                       FileError);
  CHECK(naming("leg 3", [] { return 7; }) == 7);
}
