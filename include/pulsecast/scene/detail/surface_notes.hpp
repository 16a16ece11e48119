// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_DETAIL_SURFACE_NOTES_HPP
#define PULSECAST_SCENE_DETAIL_SURFACE_NOTES_HPP

#include <cstddef>
#include <span>

#include <pulsecast/concepts.hpp>

/// What a scene notes of the surfaces of some hits, from `first` up to `end`.
namespace PULSECAST_NAMESPACE::detail {

/// What is noted of surfaces where nobody asks for them.
struct NotesNothing {
  template <class Sample, class Normal>
  void operator()(std::size_t, std::size_t, const Sample&, const Normal&) const noexcept {}
};

/// Notes the surface of each hit.
struct NotesSurfaces {
  std::span<HitSurface> surfaces;
  template <class Sample, class Normal>
  void operator()(std::size_t first, std::size_t end, const Sample& sample, const Normal& normal) const noexcept {
    const HitSurface surface{sample.material, normal(), sample.foliage, sample.texture};
    for (std::size_t j = first; j < end; ++j) surfaces[j] = surface;
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
