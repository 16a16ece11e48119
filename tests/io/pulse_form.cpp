// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/pulse_form.hpp>

#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "support/file_errors.hpp"
#include "support/relative.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

MeasuredPulse read(const std::string& text) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "pulse.txt", std::ios::binary) << text;
  return read_pulse_form(folder / "pulse.txt");
}

std::string error(const std::string& text) {
  return support::file_error([&] { (void)read(text); }).what();
}

}  // namespace

TEST_CASE("a pulse is read in nanoseconds, about its peak and relative to it") {
  for (const char* text : {"time,power\n10,0\n11,4\n12.5,2\n14,-0.1\n", "# a laser\n10;0\n11;4\n12.5;2\n14;0",
                           "10 0\r\n11 4\r\n12.5 2\r\n14 0\r\n"}) {
    INFO(text);
    const MeasuredPulse pulse = read(text);
    CHECK(pulse.power(0, 4e-9) == 1);
    CHECK(pulse.power(1.5e-9, 4e-9) == support::relative(0.5, 1e-6));
    CHECK(pulse.power(-0.5e-9, 4e-9) == support::relative(0.5, 1e-6));
    CHECK(pulse.begin(4e-9) == support::relative(-1e-9, 1e-6));
    CHECK(pulse.end(4e-9) == support::relative(3e-9, 1e-6));
  }
}

TEST_CASE("what is no pulse is refused, with its line") {
  CHECK(error("1,2\n").find("two rows at least") != std::string::npos);
  CHECK(error("time,power\n").find("two rows at least") != std::string::npos);
  CHECK(error("1,0\n2,0\n").find("some power above 0") != std::string::npos);
  CHECK(error("1,0\n2,1\n2,0\n").find("line 3") != std::string::npos);
  CHECK(error("1,0\n2,1\n3,0,5\n").find("3 columns") != std::string::npos);
  CHECK(error("1,0\n2,much\n").find("much") != std::string::npos);
  CHECK(error("1,0\n2e300,1\n").find("within 1e9 ns") != std::string::npos);
  CHECK(error("1,0\ntime,power\n").find("line 2") != std::string::npos);
}

}  // namespace pulsecast::io
