// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <typeinfo>
#include <vector>

#include <pulsecast/deflector/aim.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/material/phong.hpp>
#include <pulsecast/pulsecast.hpp>

/// The same survey from files that are compiled with other flags or macros, in one program.
namespace pulsecast::support {

/// Answer of a file: what must be equal, and what must not. Without containers, which files may have in other layouts.
struct AnswerOfFile {
  std::unique_ptr<double[]> numbers{};  ///< of all echoes, and of rotations
  std::size_t count = 0;                ///< of the numbers
  const void* function = nullptr;       ///< address of a function that the library's headers define
  const char* pose = nullptr;           ///< name of a type of the library, for the linker
};

[[nodiscard]] AnswerOfFile answer_of_avx2();
[[nodiscard]] AnswerOfFile answer_of_other_settings();

namespace {

/// Answer of the file that includes this one. The namespace has no name, so that each file has a function of its own.
[[nodiscard, maybe_unused]] AnswerOfFile answer_of_this_file() {
  using Mesh = TriangleMesh<>;
  using Intersect = void(const TrianglePacket&, std::span<const PrimitiveIndex>, const RayBundle&, ClosestHits&,
                         const detail::SolidEverywhere&, unsigned) noexcept;
  MeshData ridge;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const double x = 2.0 * i - 60, height = 3 * (i % 7) + 0.25 * (i % 3);
    ridge.vertices.insert(ridge.vertices.end(), {{x, -80, height}, {x, 80, 0.5 * height}});
    if (i > 0)
      ridge.triangles.insert(ridge.triangles.end(), {{2 * i - 2, 2 * i, 2 * i - 1}, {2 * i - 1, 2 * i, 2 * i + 1}});
  }
  const Material glossy{.law = Phong{0.4, 12.5}};
  const Scene<Mesh> scene({{.geometry = std::make_shared<const Mesh>(ridge), .materials = material_table({glossy})}});
  const Laser laser{.wavelength = 1.064e-6, .peak_power = 50, .pulse_length = 4e-9, .divergence = 5e-3};
  const Platform airplane{StraightLine{.from = {-40, 0, 100}, .to = {40, 3, 101}, .speed = 30},
                          Mount{.boresight = rotation_about(axis::right, -1.4)},
                          Deflector{OscillatingMirror{.cycle_rate = 20, .half_angle = 0.3},
                                    Scanner{.pulse_rate = 1000, .pulses = 2000, .laser = laser}}};
  std::vector<double> numbers;
  const Survey survey{airplane, SunflowerFootprint{19}, scene, Receiver{},
                      FullWaveform{WaveformSettings{}, GaussianFit{}}};
  run(survey, {.threads = 1}, [&](const EchoBatch& batch) {
    for (const Echo& echo : batch.echoes)
      numbers.insert(numbers.end(), {echo.range, echo.amplitude, echo.width, echo.reflectance, echo.cos_incidence});
  });
  const Pose<frame::Instrument, frame::World> pose{extrinsic({{axis::up, 0.3}, {axis::right, -1.1}}), {1, 2, 3}};
  for (const Rotation& r :
       {pose.rotation, no_rotation, aimed_at(0.4, 0.2).rotation, rotation_of(matrix_of(pose.rotation))})
    numbers.insert(numbers.end(), {r.w, r.x, r.y, r.z, (r * axis::forward).x, (r * axis::forward).z});
  AnswerOfFile answer{std::make_unique<double[]>(numbers.size()), numbers.size(),
                      reinterpret_cast<const void*>(
                          static_cast<Intersect*>(&intersect<RayBundle, ClosestHits, detail::SolidEverywhere>)),
                      typeid(pose).name()};
  std::copy(numbers.begin(), numbers.end(), answer.numbers.get());
  return answer;
}

}  // namespace
}  // namespace pulsecast::support
