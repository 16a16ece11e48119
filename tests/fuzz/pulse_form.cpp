// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/pulse_form.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(pulse_form) {
  const std::filesystem::path path = fuzz::file(data, size, "pulse.txt");
  fuzz::may_refuse([&] {
    const MeasuredPulse pulse = read_pulse_form(path);
    fuzz::expect(pulse.power(0, 1e-9) == 1 && pulse.begin(1e-9) <= 0 && pulse.end(1e-9) >= 0);
    for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      const double power = pulse.power(pulse.begin(1e-9) + share * (pulse.end(1e-9) - pulse.begin(1e-9)), 1e-9);
      fuzz::expect(power >= 0 && power <= 1);
    }
  });
}
