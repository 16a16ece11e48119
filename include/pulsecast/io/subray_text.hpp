// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <utility>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/output_file.hpp>

namespace pulsecast::io {

/// Writes what the subrays of a `WithSubrayRecord` footprint met as text, one hit a line, with these columns and a blank between them:
///
///     fullwaveIndex subray x y z range intensity cosIncidence backscatter hitObjectId classification
///
/// fullwaveIndex: the pulse's slot, as in the files of points; subray: its number in the footprint, from 0; x, y, z: where it met something
/// [m], 4 decimals; range [m], 4; intensity: received power, as if the pulse had no length [nW], 9; cosIncidence and backscatter, as in
/// `Hit`, 6 each; object and class. Subrays that met nothing have no line. There is no head line.
/// Only `close()` makes the file: see `OutputFile`.
class SubrayTextWriter {
 public:
  explicit SubrayTextWriter(std::filesystem::path path) : text_(OutputFile(std::move(path))) {}
  explicit SubrayTextWriter(OutputFile file) : text_(std::move(file)) {}

  void operator()(const EchoBatch& batch) {
    for (std::size_t i = 0; i < batch.shots.size(); ++i) {
      std::size_t subray = 0;
      for (const SubrayHit& hit : batch.subrays_of(i)) {
        if (hit.met()) write(batch.shots[i], subray, hit);
        ++subray;
      }
    }
  }

  void close() { text_.close(); }

 private:
  void write(const Shot& shot, std::size_t subray, const SubrayHit& hit) {
    constexpr double nano = 1e9;  // of a unit
    text_.wholes(shot.index, subray).vector("the place of a hit", hit.point, 4).reals(4, hit.range).reals(9, hit.power * nano);
    text_.reals(6, hit.cos_incidence, hit.backscatter).wholes(hit.object, hit.classification).end_row();
  }

  TextOutput text_;
};
static_assert(EchoSink<SubrayTextWriter>);

}  // namespace pulsecast::io
