// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/vox.hpp>

#include <algorithm>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(vox) {
  const std::filesystem::path path = fuzz::file(data, size, "grid.vox");
  for (const VoxelFileSettings& settings : {VoxelFileSettings{}, VoxelFileSettings{.use = VoxelUse::opaque},
                                            VoxelFileSettings{.use = VoxelUse::scaled, .shift = 1}})
    fuzz::may_refuse([&] {
      const VoxelFile file = read_voxel_file(path, settings);
      const VoxelData& voxels = file.voxels;
      voxels.validate();
      fuzz::expect(voxels.cells.size() <= size);
      fuzz::expect(file.transmittances.empty() || file.transmittances.size() == voxels.cells.size());
      fuzz::expect(voxels.densities.size() == (settings.use == VoxelUse::transmissive ? voxels.cells.size() : 0));
      fuzz::expect(voxels.scales.size() == (settings.use == VoxelUse::scaled ? voxels.cells.size() : 0));
      fuzz::expect(voxels.shifts.size() == voxels.scales.size());
      auto cells = voxels.cells;
      std::sort(cells.begin(), cells.end());
      fuzz::expect(std::adjacent_find(cells.begin(), cells.end()) == cells.end());
    });
}
