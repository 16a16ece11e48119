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

/// Writes the hits of the subrays of a `WithSubrayRecord` footprint as text, one a line, with these columns and blanks between:
///
///     fullwaveIndex subray x y z range intensity cosIncidence backscatter hitObjectId classification
///
/// fullwaveIndex: slot of the pulse, as in point files; subray: number in the footprint, from 0; x, y, z: hit point [m], 4 decimals; range
/// [m], 4; intensity: received power of a pulse without length [nW], 9; cosIncidence and backscatter as in `Hit`, 6 each; object and class.
/// Subrays without a hit have no line. There is no header line. Only `close()` completes the file: see `OutputFile`. Throws a `FileError`.
class SubrayTextWriter {
 public:
  /// Opens the file. @throws FileError
  explicit SubrayTextWriter(std::filesystem::path path) : text_(OutputFile(std::move(path))) {}
  /// Writes to an open file.
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
    constexpr double nano = 1e9;  // per unit
    text_.wholes(shot.index, subray).vector("the position of a hit", hit.point, 4).reals(4, hit.range).reals(9, hit.power * nano);
    text_.reals(6, hit.cos_incidence, hit.backscatter).wholes(hit.object, hit.classification).end_row();
  }

  TextOutput text_;
};
static_assert(EchoSink<SubrayTextWriter>);

}  // namespace pulsecast::io
