// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/find_hits.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstddef>

#include "support/archetypes.hpp"

using namespace pulsecast;

TEST_CASE("a map for bundles and a map for rays answer a bundle alike") {
  RayBundle rays;
  rays.origin = {0, 0, 3};
  rays.size = 3;
  rays.set_direction(0, -axis::up);
  rays.set_direction(1, {0, 0.6, -0.8});
  rays.set_direction(2, axis::up);
  rays.pad();
  std::array<Hit, 3> of_bundle, of_rays;
  find_hits(support::LeastBundleTarget{}, rays, of_bundle);
  find_hits(support::LeastRayTarget{}, rays, of_rays);
  CHECK(of_rays[0].range == 3);
  CHECK(of_rays[1].range == doctest::Approx(3.75));
  CHECK_FALSE(of_rays[2].met());
  for (std::size_t j = 0; j < 3; ++j) {
    CHECK(of_bundle[j].range == of_rays[j].range);
    CHECK(of_bundle[j].backscatter == of_rays[j].backscatter);
  }
}

TEST_CASE("a map that cannot tell of a cone does not miss it") {
  CHECK_FALSE(pulsecast::detail::misses_cone(support::LeastRayTarget{}, {}));
}
