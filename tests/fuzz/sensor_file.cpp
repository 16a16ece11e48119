// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/sensor_file.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(sensor_file) {
  const std::filesystem::path path = fuzz::file(data, size, "unit");
  fuzz::may_refuse([&] {
    const SensorSheet sheet = read_sensor(path);
    sheet.validate();
    fuzz::expect(!sheet.lasers.empty());
    fuzz::expect(sheet.source(0).size() == 0);
  });
}
