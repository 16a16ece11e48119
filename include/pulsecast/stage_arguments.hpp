// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_STAGE_ARGUMENTS_HPP
#define PULSECAST_STAGE_ARGUMENTS_HPP

#include <pulsecast/concepts.hpp>

/// Arguments of `Deflector`, `Platform` and `Survey`. Deduction guides that take all others name the mistake, by static
/// assertions.
// clang-format off
// version 14 breaks up compound requirements
namespace PULSECAST_NAMESPACE::detail {

/// Optic or head before a source that it deflects.
template <class Moving, class Source>
concept Deflectable = (Optic<Moving> && BeamSource<Source>) || (Head<Moving> && InstrumentSource<Source>);

/// Forwarded argument that is a temporary: one that is not is a reference.
template <class T>
concept Temporary = !std::is_lvalue_reference_v<T>;

/// Source, footprint, forwarded map and detector of a survey.
template <class Source, class Pattern, class Map, class Instrument>
concept Surveyable =
    WorldSource<Source> && Footprint<Pattern> && !Temporary<Map> && Target<std::remove_cvref_t<Map>> && Detector<Instrument>;

/// Own optic, head or trajectory.
template <class M>
struct MotionArgument {
  static_assert(!requires(M m, Tick t) { m.at(t); } || requires(const M m, Tick t) { m.at(t); },
                "at(Tick) of an optic, head or trajectory must be const");
  static_assert(!requires(const M m, Tick t) { m.at(t); } || requires(const M m, Tick t) { { m.at(t) } noexcept; },
                "at(Tick) of an optic, head or trajectory must be noexcept");
};

template <class Moving, class Source>
struct DeflectorArguments : MotionArgument<Moving> {
  static_assert(!Deflectable<Source, Moving>, "Deflector{optic, source}: the arguments are swapped");
  static_assert(Deflectable<Moving, Source>,
                "Deflector{optic, source} takes an optic and a Scanner, or a head and a Deflector; of your own: static_assert(Optic<T>)");
  using First = Moving;
};

template <class Path, class Source, bool mounted>
struct PlatformArguments : MotionArgument<Path> {
  static_assert(!BeamSource<Source>,
                "Platform{trajectory, mount, source}: a bare Scanner needs a deflector: Deflector{FixedBeam{}, scanner}");
  static_assert(mounted, "Platform{trajectory, mount, source}: the second argument must be a mount: Mount{}");
  static_assert(Trajectory<Path> && InstrumentSource<Source>,
                "Platform{trajectory, mount, source} takes a Trajectory and a Deflector; of your own: static_assert(Trajectory<T>)");
  using First = Path;
};

template <class Source, class Pattern, class Map, class Instrument>
struct SurveyArguments {
  static_assert(!Temporary<Map>, "Survey: the map is a temporary; name it, as it must outlive the survey");
  static_assert(WorldSource<Source>, "Survey: the source must be a Platform, or joined ones; of your own: static_assert(WorldSource<T>)");
  static_assert(Footprint<Pattern>, "Survey: the second argument must be a Footprint; of your own: static_assert(Footprint<T>)");
  static_assert(Target<std::remove_cvref_t<Map>>, "Survey: the map must be a Target; of your own: static_assert(Target<T>)");
  static_assert(Detector<Instrument>, "Survey: the detector must be a Detector; of your own: static_assert(Detector<T>)");
  using First = Source;
};

template <class Source, class Pattern, class Map, class Light, class Instrument>
struct TransportArguments : SurveyArguments<Source, Pattern, Map, Instrument> {
  static_assert(requires(const Light t, std::size_t n) { t.workspace(n); },
                "Transport, Survey's fourth argument: 'workspace' is missing or has another form; it must be: "
                "Workspace workspace(std::size_t) const");
  static_assert(requires(const Light t, std::size_t n) { { t.reflections(n) } noexcept -> std::same_as<std::size_t>; },
                "Transport, Survey's fourth argument: 'reflections' is missing or has another form; it must be: "
                "std::size_t reflections(std::size_t) const noexcept");
  static_assert(!std::copyable<Light> || Transport<Light, std::remove_cvref_t<Map>>,
                "Transport, Survey's fourth argument: 'trace' is missing or has another form for this map; it must be: "
                "TransportResult trace(const Map&, const TransportInput&, Workspace&, std::span<Reflection>) const noexcept");
  static_assert(std::copyable<Light>, "Transport, Survey's fourth argument: it must be copyable");
};

}  // namespace pulsecast::detail

#endif
