// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/sensor_calibration.hpp>

#include <pulsecast/sensor/velodyne.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(sensor_calibration) {
  const std::filesystem::path path = fuzz::file(data, size, "unit");
  fuzz::may_refuse([&] {
    const SpinningSensor sensor = read_velodyne_calibration(path, velodyne_vlp_16());
    sensor.validate();
    fuzz::expect(sensor.lasers.size() == 16);
  });
  fuzz::may_refuse([&] {
    const SpinningSensor sensor = read_ouster_metadata(path);
    sensor.validate();
    fuzz::expect(sensor.lasers.size() == 64);
  });
}
