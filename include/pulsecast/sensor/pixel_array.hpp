// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SENSOR_PIXEL_ARRAY_HPP
#define PULSECAST_SENSOR_PIXEL_ARRAY_HPP

#include <pulsecast/deflector/aim.hpp>
#include <pulsecast/scanner/scanner.hpp>

namespace PULSECAST_NAMESPACE {

/// Pixels with a global shutter, as of a depth camera or flash lidar: all of a frame fire at its time.
/// Slot `(frame * rows + row) * columns + column` is a pixel of a pinhole camera, evenly spaced in the
/// tangents; row 0 is the uppermost, column 0 the leftmost. A focal length of f pixels is a field of view
/// of `2 * std::atan(columns / (2 * f))`. Depth along forward is range times `direction(...).y`.
struct PixelArray {
  using refinements = refines<tag::FindsSlots, tag::MakesLanes, tag::StridesLanes, tag::Validated>;
  static constexpr bool strides_lanes = true;
  std::uint32_t columns = 320;      ///< number of columns, from 1 to 100,000
  std::uint32_t rows = 240;         ///< number of rows, from 1 to 100,000
  double horizontal_view = pi / 3;  ///< full angle between the outer edges of the columns [rad]
  double vertical_view = pi / 4;    ///< full angle between the outer edges of the rows [rad]
  double frame_rate = 30;           ///< frames per second, from 1e-3 to 1e12 [Hz]
  PulseIndex frames = 1;            ///< number of frames; at most 2^52 pulses
  Laser laser{};                    ///< beam of each pixel

  void validate() const {
    require_within("PixelArray::columns", columns, 1, 1e5, "");
    require_within("PixelArray::rows", rows, 1, 1e5, "");
    for (const double view : {horizontal_view, vertical_view})
      require_within("PixelArray::horizontal_view or vertical_view", view, 0, 3, "rad");
    require_within("PixelArray::frames", static_cast<double>(frames), 0, 0x1p52 / static_cast<double>(pixels()), "");
    require_within("PixelArray::frame_rate", frame_rate, 1e-3, 1e12, "Hz");
    shutter().validate();
  }

  [[nodiscard]] PulseIndex pixels() const noexcept { return PulseIndex{columns} * rows; }  ///< of a frame
  [[nodiscard]] PulseIndex size() const noexcept { return frames * pixels(); }
  [[nodiscard]] Tick duration() const noexcept { return shutter().duration(); }
  [[nodiscard]] std::vector<Emitter> emitters() const { return shutter().emitters(); }
  /// First slot of the first frame at or after a time.
  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept { return shutter().slot_from(t) * pixels(); }

  /// Unit direction of a pixel, in the frame of the instrument.
  [[nodiscard]] Vec3 direction(std::uint32_t column, std::uint32_t row) const noexcept {
    return directions(PulseIndex{row} * columns + column, 1)[0];
  }

  [[nodiscard]] std::optional<Pulse<frame::Instrument>> pulse(PulseIndex i) const noexcept {
    return pulse_lanes(i, 1)[0];
  }

  [[nodiscard]] PulseLanes<frame::Instrument> pulse_lanes(PulseIndex i, std::size_t count,
                                                          PulseIndex step = 1) const noexcept {
    PulseLanes<frame::Instrument> p;
    p.size = count;
    p.sent = first_lanes(count);
    for (std::size_t lane = 0; lane < count; ++lane)
      p.tick.set(lane, Tick::of((i + lane * step) / pixels(), frame_rate));
    p.pose = aimed_along(directions(i, step));
    return p;
  }

 private:
  [[nodiscard]] Scanner shutter() const noexcept {
    return {.pulse_rate = frame_rate, .pulses = frames, .laser = laser};
  }

  /// Unit directions of every `step`-th slot from i on.
  [[nodiscard]] Vec3Lanes directions(PulseIndex i, PulseIndex step) const noexcept {
    const auto place = [](PulseIndex k, PulseIndex number) {  // from -1 to 1
      return (2 * static_cast<double>(k % number) + 1) / static_cast<double>(number) - 1;
    };
    const simd::Doubles across = simd::generate([&](std::size_t lane) { return place(i + lane * step, columns); });
    const simd::Doubles down =
        simd::generate([&](std::size_t lane) { return place((i + lane * step) / columns, rows); });
    const auto h = simd::sincos(horizontal_view / 2), v = simd::sincos(vertical_view / 2);
    return normalize(Vec3Lanes{across * (h.sin / h.cos), simd::Doubles{} + 1.0, down * (-v.sin / v.cos)});
  }
};
static_assert(InstrumentSource<PixelArray>);

}  // namespace PULSECAST_NAMESPACE

#endif
