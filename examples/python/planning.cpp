// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "planning.hpp"

#include <vector>

#include <pulsecast/helios/settings.hpp>
#include <pulsecast/platform/block_flight.hpp>

#include "settings.hpp"

namespace py = pybind11;
using namespace pulsecast;
using namespace py::literals;

namespace {

py::object legs_of(py::handle block, py::handle scanner) {
  std::vector<helios::LegSettings> legs;
  helios::LegScannerSettings active;
  if (!scanner.is_none()) active = leg_scanner_of(scanner);
  helios::LegScannerSettings turning = active;
  turning.active = false;
  for (const StraightLine& line : plan_block_flight(block_flight_of(block))) {
    legs.push_back({.platform = {.position = line.from, .speed = line.speed}, .scanner = active});
    legs.push_back({.platform = {.position = line.to, .speed = line.speed}, .scanner = turning});
  }
  return to_python(legs);
}

}  // namespace

void bind_planning(py::module_& m) {
  m.def("plan_block_flight", &legs_of, "block"_a, "scanner"_a = py::none(),
        "Legs of parallel lines that cover an area, in alternating directions, for a platform of the kind "
        "'linear_path'; an inactive leg leads from each line to the next. block: BlockFlight; scanner: "
        "LegScannerSettings of the lines. Raises SettingError.");
}
