// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/radiometry.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;

namespace {
const double infinity = std::numeric_limits<double>::infinity();
const double nan_value = std::numeric_limits<double>::quiet_NaN();
}  // namespace

TEST_CASE("molecules absorb on both ways") {
  const Receiver absorbing{.visibility = infinity, .absorption = 1e-3};
  const Receiver clear{.visibility = infinity};
  CHECK(LinkBudget(absorbing, Laser{}).power(1, 1, 500) ==
        support::relative(std::exp(-1.0) * LinkBudget(clear, Laser{}).power(1, 1, 500), 1e-14));
  CHECK_THROWS_AS(Receiver{.absorption = -1}.validate(), SettingError);
}

TEST_CASE("air that one sees through without end does not weaken") {
  CHECK(extinction(1.064e-6, infinity) == 0);
  CHECK(LinkBudget(Receiver{.visibility = infinity}, Laser{}).power(1, 1, 1e9) > 0);
}

TEST_CASE("received power is that of the laser radar equation, by hand") {
  const Laser laser{.wavelength = 1.064e-6, .peak_power = 4};
  const Receiver receiver{.diameter = 0.15, .efficiency = 0.99, .visibility = 23e3};
  // 4 W * 0.15^2 / (4 * 100^2 + 0.15^2) * 0.5 * 0.99 * exp(-2 * 100 * 7.20935317364042e-05)
  CHECK(LinkBudget(receiver, laser).power(1, 0.5, 100) == support::relative(1.0978057676610609e-06, 1e-13));
  const Receiver vacuum{.diameter = 0.15, .efficiency = 0.99, .visibility = infinity};
  CHECK(LinkBudget(vacuum, laser).power(1, 0.5, 100) == support::relative(1.1137493735159774e-06, 1e-13));
}

TEST_CASE("received power falls with the square of the range, and with what the air takes both ways") {
  const Receiver narrow{.diameter = 1e-4, .visibility = infinity};  // far from its aperture at all of these ranges
  CHECK(LinkBudget(narrow, Laser{}).power(1, 1, 10) / LinkBudget(narrow, Laser{}).power(1, 1, 30) ==
        support::relative(9, 1e-10));
  const LinkBudget vacuum(Receiver{.visibility = infinity}, Laser{}), air(Receiver{.visibility = 5e3}, Laser{});
  for (const double range : {1.0, 10.0, 1000.0}) {
    CHECK(air.power(1, 1, range) / vacuum.power(1, 1, range) ==
          support::relative(std::exp(-2 * extinction(Laser{}.wavelength, 5e3) * range), 1e-14));
  }
}

TEST_CASE("received power is proportional to share and backscatter, so that shares of one sum to the whole") {
  const LinkBudget budget(Receiver{}, Laser{});
  CHECK(budget.power(0.25, 1, 50) == support::relative(0.25 * budget.power(1, 1, 50), 1e-15));
  CHECK(budget.power(1, 0.3, 50) == support::relative(0.3 * budget.power(1, 1, 50), 1e-15));
  CHECK(budget.power(1, 0, 50) == 0);
}

TEST_CASE("several subrays at once bring back what each brings back alone") {
  const LinkBudget budget(Receiver{.visibility = 5e3}, Laser{});
  for (const double range : {0.01, 1.0, 100.0, 3000.0, 1e6}) {
    simd::Doubles share{}, backscatter{}, ranges{};
    for (std::size_t k = 0; k < simd::lane_count; ++k) {
      const double n = static_cast<double>(k);
      share[k] = 0.1 + 0.01 * n;
      backscatter[k] = 0.3 * n;
      ranges[k] = range * (1 + 0.1 * n);
    }
    const simd::Doubles power = budget.power_in_view(share, backscatter, ranges);
    for (std::size_t k = 0; k < simd::lane_count; ++k) {
      const double alone = budget.power(share[k], backscatter[k], ranges[k]);
      CHECK(std::fabs(power[k] - alone) <= 2e-15 * alone);
    }
  }
}

TEST_CASE(
    "near by, an aperture holds sin^2 of half the angle that it subtends, of what a Lambertian surface scatters") {
  const Receiver receiver{.diameter = 0.2, .efficiency = 1, .visibility = infinity};
  const LinkBudget budget(receiver, Laser{.peak_power = 4});
  for (const double range : {0.0, 1e-9, 0.01, 0.1, 0.2, 3.0, 1e4})
    CHECK(budget.power(1, 1, range) == support::relative(4 * std::pow(std::sin(std::atan2(0.1, range)), 2), 1e-14));
  CHECK(budget.power(1, 1, 0) == support::relative(4, 1e-14));  // all that was sent, and never more
  CHECK(budget.power(1, 1, 0.1) == support::relative(2, 1e-14));
}

TEST_CASE("a receiver's gate holds its ends") {
  const Receiver receiver{.range_min = 2, .range_max = 100};
  CHECK(receiver.gate().contains(2));
  CHECK(receiver.gate().contains(100));
  CHECK_FALSE(receiver.gate().contains(1.9999));
  CHECK_FALSE(receiver.gate().contains(100.0001));
  CHECK(Receiver{}.gate().contains(1e9));
}

TEST_CASE("a receiver refuses what cannot be") {
  CHECK_NOTHROW(Receiver{}.validate());
  CHECK_NOTHROW(Receiver{.visibility = infinity}.validate());
  for (const double bad : {0.0, 9e-5, 1001.0, -1.0, nan_value, infinity})
    CHECK_THROWS_AS(Receiver{.diameter = bad}.validate(), SettingError);
  for (const double bad : {-0.1, 1.1, nan_value}) CHECK_THROWS_AS(Receiver{.efficiency = bad}.validate(), SettingError);
  for (const double bad : {0.0, -1.0, nan_value}) CHECK_THROWS_AS(Receiver{.visibility = bad}.validate(), SettingError);
  for (const double bad : {-0.1, nan_value, infinity})
    CHECK_THROWS_AS(Receiver{.range_min = bad}.validate(), SettingError);
  CHECK_THROWS_AS((Receiver{.range_min = 5, .range_max = 4}.validate()), SettingError);
  CHECK_THROWS_AS(Receiver{.range_max = nan_value}.validate(), SettingError);
}

TEST_CASE("a range error is its bias, and a deviation that grows with range and incidence") {
  CHECK(RangeErrors{}.none());
  CHECK(RangeErrors{.bias = 0.01}.at(Echo{.range = 100, .cos_incidence = 1}, 2) == 0.01);
  CHECK(RangeErrors{.deviation = 0.005}.at(Echo{.range = 100, .cos_incidence = 0.5}, 2) ==
        support::relative(0.01, 1e-15));
  CHECK(RangeErrors{.deviation = 0.005, .deviation_per_metre = 1e-5}.at(Echo{.range = 1000, .cos_incidence = 0.5},
                                                                        -1) == support::relative(-0.015, 1e-14));
  CHECK(RangeErrors{.deviation = 0.005, .grows_with_incidence = true}.at(Echo{.range = 100, .cos_incidence = 0.5}, 1) ==
        support::relative(0.01, 1e-14));
  CHECK(std::isfinite(
      RangeErrors{.deviation = 0.005, .grows_with_incidence = true}.at(Echo{.range = 100, .cos_incidence = 0}, 1)));
  CHECK(RangeErrors{.scale = 1e-5}.at(Echo{.range = 1000}, 3) == support::relative(0.01, 1e-14));
  CHECK_FALSE(RangeErrors{.scale = 1e-5}.none());
  const RangeErrors by_power{.deviation = 0.001, .deviation_at_watt = 1e-6, .power_exponent = -0.5};
  CHECK(by_power.at(Echo{.range = 10, .amplitude = 1e-6}, 1) == support::relative(0.002, 1e-14));
  CHECK(by_power.at(Echo{.range = 10, .amplitude = 4e-6}, 1) == support::relative(0.0015, 1e-14));
  CHECK_FALSE(by_power.none());
  const RangeErrors by_channel{.bias = 0.001, .channel_biases = SharedArray<double>({0.01, -0.02})};
  CHECK_FALSE(by_channel.none());
  CHECK(by_channel.at(Echo{.range = 10}, 1, 0) == support::relative(0.011, 1e-14));
  CHECK(by_channel.at(Echo{.range = 10}, 1, 1) == support::relative(-0.019, 1e-14));
  CHECK(by_channel.at(Echo{.range = 10}, 1, 2) == 0.001);
  CHECK_THROWS_AS(RangeErrors{.channel_biases = SharedArray<double>({0.0, std::nan("")})}.validate(), SettingError);
  CHECK_THROWS_AS(RangeErrors{.power_exponent = 1}.validate(), SettingError);
  CHECK_THROWS_AS(RangeErrors{.deviation = -1}.validate(), SettingError);
  const RangeErrors table{.bias = 0.5,
                          .deviations = std::vector<DeviationAtRange>{{10, 0.01}, {20, 0.03}, {100, 0.02}}};
  CHECK_NOTHROW(table.validate());
  CHECK_FALSE(table.none());
  CHECK(table.at(Echo{.range = 5, .cos_incidence = 1}, 1) == support::relative(0.51, 1e-14));
  CHECK(table.at(Echo{.range = 10, .cos_incidence = 1}, 1) == support::relative(0.51, 1e-14));
  CHECK(table.at(Echo{.range = 12.5, .cos_incidence = 1}, 1) == support::relative(0.515, 1e-14));
  CHECK(table.at(Echo{.range = 60, .cos_incidence = 1}, -2) == support::relative(0.45, 1e-14));
  CHECK(table.at(Echo{.range = 1e6}, 1) == support::relative(0.52, 1e-14));
  CHECK_THROWS_AS((RangeErrors{.deviations = std::vector<DeviationAtRange>{{10, 0.01}, {10, 0.02}}}.validate()),
                  SettingError);
  CHECK_THROWS_AS((RangeErrors{.deviations = std::vector<DeviationAtRange>{{10, -0.01}}}.validate()), SettingError);
  CHECK_THROWS_AS(RangeErrors{.bias = std::numeric_limits<double>::infinity()}.validate(), SettingError);
}

TEST_CASE("a white target has the power of its budget at any range, asked in any order") {
  const LinkBudget budget(Receiver{}, Laser{});
  WhiteTarget white;
  for (const double range : {0.0, 10.0, 10.0, 500.0, 10.0, 0.0, -1.0})
    CHECK(white.power(budget, range) == budget.power(1, 1, range));
}
