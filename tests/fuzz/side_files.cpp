// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/side_files.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(side_files) {
  for (const char* name : {"dem.prj", "dem.tif.aux.xml"}) {
    const std::filesystem::path beside = fuzz::file(data, size, name);
    fuzz::may_refuse([&] {
      std::vector<std::string> warnings;
      const SpatialReference found =
          io::detail::read_side_files(beside.parent_path() / "dem.tif", warnings, io::detail::HeightUnit::metre);
      for (const double unit : {found.unit, found.vertical_unit}) fuzz::expect(unit >= 1e-6 && unit <= 1e6);
      fuzz::expect(found.wkt.size() <= size);
    });
    std::filesystem::remove(beside);
  }
}
