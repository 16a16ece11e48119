// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Figures that HELIOS++ prints or that follow from what it documents, where they are right; where they are right but
// for a unit or a factor, with that put right. docs/differences-from-helios.md names the others.

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/detector/pulse_shape.hpp>
#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/material/phong.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/subray_directions.hpp>

#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::validation;

TEST_CASE("the peer's pulse in time") {
  // 4 ns in steps of 0.25 ns of its one-way time, which are 0.5 ns there and back; not normalised, so that its peak is
  // 4 / e^2
  struct Sample {
    int number;
    double power;
  };
  const PulseShape shape(4_ns, 3.5);
  for (const Sample& s : {Sample{1, 0.123581163261589},
                          {3, 0.463646639803008},
                          {5, 0.536879651903989},
                          {10, 0.240944910109088},
                          {15, 0.0608248568271227}})
    row(Kind::peer, "pulse of 4 ns, sample " + std::to_string(s.number) + " of 15, by its peak",
        s.power * PulseShape::to_unit_peak, shape(s.number * 0.5_ns - PulseShape::peak * shape.tau), 1e-6);
}

TEST_CASE("the peer's extinction, with wavelengths in micrometres and an answer per kilometre") {
  struct Case {
    double wavelength_nm, visibility_km, extinction, q;
  };
  for (const Case& c : {Case{1064, 23, 9.07603791289485e-6, 1.3},
                        {1550, 23, 5.56530807265444e-6, 1.3},
                        {905, 23, 1.12015278955261e-5, 1.3},
                        {1064, 60, 3.59334739360422e-7, 1.6}})
    row(Kind::peer,
        "extinction at " + std::to_string(static_cast<int>(c.wavelength_nm)) + " nm, visibility " +
            std::to_string(static_cast<int>(c.visibility_km)) + " km, its units put right [1/km]",
        c.extinction * std::pow(1000, c.q), extinction(c.wavelength_nm * 1e-9, c.visibility_km * 1e3) * 1e3, 1e-6);
}

TEST_CASE("the peer's received power, without its factor of pi, with its extinction and the solid angle of a disc") {
  // its older model, the central of 19 subrays, reflectance 50, 4 W; in nanowatts, and by D^2 / (4 R^2) however near
  struct Case {
    double range, power;
  };
  const Receiver receiver{.diameter = 0.15, .efficiency = 0.99, .visibility = std::numeric_limits<double>::infinity()};
  const LinkBudget budget(receiver, Laser{.peak_power = 4});
  for (const Case& c : {Case{30, 204505.49363258}, {100, 18382.1224237085}, {1000, 180.8425584006}}) {
    const double air = std::exp(-2 * 9.07603791289485e-6 * c.range);
    const double disc = 1 / (1 + std::pow(receiver.diameter / (2 * c.range), 2));
    row(Kind::peer,
        "power of the axis at " + std::to_string(static_cast<int>(c.range)) + " m, its solid angle put right, of ours",
        1, c.power * disc * 1e-9 / pi / (budget.power(1.0 / 19, 50, c.range) * air), 1e-6);
  }
}

TEST_CASE("the peer's Phong, as far as its lobe reaches") {
  const Material phong{.reflectance = 0.5, .law = Phong{0.3, 10}};
  struct Case {
    double angle_deg, factor;
  };
  for (const Case& c : {Case{0, 0.5}, {20, 0.339330744918639}, {45, 0.247487373415292}})
    row(Kind::peer,
        "Phong, reflectance 0.5, share 0.3, exponent 10, " + std::to_string(static_cast<int>(c.angle_deg)) + " degrees",
        c.factor, phong.backscatter(std::cos(radians(c.angle_deg)), 1064_nm), 1e-6);
}

TEST_CASE("the peer's subrays, with the divergence as the full angle that it is") {
  const RingFootprint rings(3);
  CHECK(rings.size() == 19);
  // it puts ring i of n at i / n of the divergence, where ours stands at i / (n - 1/2) of half of it: the azimuths are
  // the same
  const struct {
    std::size_t subray;
    Vec2 across;
  } figures[] = {{1, {0, 9.99999998333333e-5}},
                 {2, {8.66025402341063e-5, 4.99999999166667e-5}},
                 {8, {9.99999993333333e-5, 1.73205080769187e-4}}};
  for (const auto& f : figures) {
    const Vec3 ours = subray_direction(rings.offset(f.subray), 0.3e-3);
    row(Kind::peer, "azimuth of subray " + std::to_string(f.subray) + " of 19 [degrees]",
        std::atan2(f.across.x, f.across.y) * 180 / pi, std::atan2(ours.x, ours.z) * 180 / pi, 1e-5);
  }
}
