// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Prints the rows of all settings of surveys, for the tables of docs/surveys.md and docs/survey-scenes.md: struct, attribute, values and default.

#include <algorithm>
#include <cstdio>
#include <string>

#include "field_list.hpp"

using namespace pulsecast::helios;

namespace {

/// Prints the rows of settings, but for those of a part of them.
template <class Settings, class Part = ConicOptic>
void print(const char* name, Settings settings = {}) {
  Part part;
  const FieldList list(settings);
  const FieldList others(part);
  for (const FieldList::Row& row : list.rows()) {
    const auto is_same = [&](const FieldList::Row& other) { return other.name == row.name; };
    if (std::any_of(others.rows().begin(), others.rows().end(), is_same) || row.name == "optics") continue;
    std::printf("%s|%s|%s|%s\n", name, row.name.c_str(), row.values.c_str(),
                list.is_required(row.name) ? "required" : row.value.value_or("none").c_str());
  }
}

}  // namespace

int main() {
  print<LegOffsetSettings>("LegOffsetSettings");
  print<LegPlatformSettings>("LegPlatformSettings");
  print<LegScannerSettings>("LegScannerSettings");
  print<SceneSettings>("SceneSettings");
  print<LightSettings>("LightSettings");
  print<MediumSettings>("MediumSettings");
  print<PartSettings>("PartSettings");
  print<ObjSource>("ObjSource");
  print<GeoTiffSource, MaterialSource>("GeoTiffSource");
  print<XyzSource, MaterialSource>("XyzSource");
  print<VoxelSource, MaterialSource>("VoxelSource");
  print<MeshSource>("MeshSource");
  print<MaterialSource>("MaterialSource");
  print<MotionSequenceSettings>("MotionSequenceSettings");
  print<SwapSettings>("SwapSettings");
  print<MulticopterDynamics>("MulticopterDynamics");
  print<MountSettings>("MountSettings");
  print<AxisTurn>("AxisTurn");
  print<NoiseSettings>("NoiseSettings");
  print<MountErrorSettings>("MountErrorSettings");
  print<TrajectorySettings>("TrajectorySettings");
  print<TrajectoryIndices>("TrajectoryIndices");
  print<ChannelSettings>("ChannelSettings", {.optic = ConicOptic{}});
  print<OscillatingOptic>("OscillatingOptic");
  print<RotatingOptic>("RotatingOptic");
  print<LineOptic>("LineOptic");
  print<RisleyOptic>("RisleyOptic");
  print<FullWaveformSettings>("FullWaveformSettings");
}
