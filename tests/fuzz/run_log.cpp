// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The log of an unfinished run, which `--resume` of the survey program believes.

#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/output_file.hpp>

#include <cmath>
#include <string>
#include <string_view>

#include "../../examples/pulsecast/run_folder.hpp"
#include "fuzz/fuzz.hpp"

using namespace pulsecast;

/// What can be read names no file outside of the run's folder, and is the same when it is written and read again.
FUZZ_TARGET(run_log) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  fuzz::may_refuse([&] {
    const RunLog log = RunLog::parse(text, "log");
    fuzz::expect(std::isfinite(log.start_time) && log.run >= 0);
    fuzz::expect(log.before.find('/') == log.before.npos && !log.before.starts_with('.'));
    for (const auto& [file, bytes] : log.files) fuzz::expect(!file.empty() && file.find('/') == file.npos);
    try {
      const RunLog same = RunLog::parse(log.text(), "again");
      fuzz::expect(same.seed == log.seed && same.start_time == log.start_time && same.run == log.run &&
                   same.how == log.how && same.inputs == log.inputs && same.before == log.before &&
                   same.files == log.files);
    } catch (const FileError&) {
      fuzz::expect(false);
    }
  });
}
