// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/first_hit.hpp>

#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "support/detect.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;

static_assert(Detector<FirstHit>);

TEST_CASE("the first hit is the nearest reflection, as it is") {
  const FirstHit detector;
  auto workspace = detector.workspace(3);
  std::vector<Reflection> reflections{{20, 3e-9, 7, 2}, {10, 1e-9, 8, 5}, {30, 2e-9, 9, 6}};
  const Detection d = support::detect(detector, Laser{}, reflections, workspace);
  REQUIRE(d.echoes.size() == 1);
  CHECK(d.echoes[0].range == 10);
  CHECK(d.echoes[0].amplitude == 1e-9);
  CHECK(d.echoes[0].object == 8);
  CHECK(d.echoes[0].classification == 5);
  CHECK(d.echoes[0].number == 1);
  CHECK(d.waveform.empty());
}

TEST_CASE("reflections below the threshold are not seen, and one on it is") {
  const FirstHit detector{.threshold = 2e-9};
  auto workspace = detector.workspace(3);
  std::vector<Reflection> weak_before_strong{{10, 1.999e-9}, {20, 2e-9}, {30, 5e-9}}, all_weak{{10, 1e-9}}, none;
  CHECK(support::detect(detector, Laser{}, weak_before_strong, workspace).echoes[0].range == 20);
  CHECK(support::detect(detector, Laser{}, all_weak, workspace).echoes.empty());
  CHECK(support::detect(detector, Laser{}, none, workspace).echoes.empty());
}

TEST_CASE("of two reflections at the same range the first subray's counts") {
  const FirstHit detector;
  auto workspace = detector.workspace(2);
  std::vector<Reflection> reflections{{10, 1e-9, 1}, {10, 2e-9, 2}};
  CHECK(support::detect(detector, Laser{}, reflections, workspace).echoes[0].object == 1);
}

TEST_CASE("the first hit keeps the laws of a detector") {
  support::Generator any(1);
  std::vector<std::vector<Reflection>> cases{{}};
  for (int k = 0; k < 200; ++k) {
    std::vector<Reflection> c(any.whole(20));
    for (Reflection& r : c)
      r = {any.log_uniform(1, 1e4), any.log_uniform(1e-12, 1e-3), static_cast<ObjectId>(any.whole(5)), 0};
    cases.push_back(c);
  }
  CHECK(support::detector_laws(FirstHit{.threshold = 1e-9}, Laser{}, cases) == "");
}

TEST_CASE("a first hit refuses a threshold that is none") {
  CHECK_THROWS_AS(FirstHit{.threshold = -1}.validate(), SettingError);
  CHECK_THROWS_AS(FirstHit{.threshold = std::numeric_limits<double>::quiet_NaN()}.validate(), SettingError);
}
