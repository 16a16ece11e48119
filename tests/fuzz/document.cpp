// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/document.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::helios;

/// The input is a document of a survey and of assets, which may name itself, and a file `a`. What can be read can be
/// written, and read again.
FUZZ_TARGET(document) {
  static constexpr std::uint8_t mesh[] = "v 0 0 0\n";
  static const std::filesystem::path folder = fuzz::file(mesh, sizeof mesh - 1, "a").parent_path();
  const std::filesystem::path path = fuzz::file(data, size, "a.xml"), again = folder / "b.xml";
  fuzz::may_refuse([&] {
    const SurveyDocument document = read_survey(path);
    fuzz::expect(!document.survey.legs.empty() && !document.survey.scanner.channels.empty());
    for (const LegSettings& leg : document.survey.legs)
      fuzz::expect(leg.scanner.pulse_rate > 0 && leg.platform.speed >= 0);
    write_survey(again, document.survey);
    try {
      fuzz::expect(read_survey(again).survey == document.survey);
    } catch (const FileError&) {
      fuzz::expect(false);
    }
  });
  fuzz::may_refuse([&] {
    const AssetDocument assets = read_assets(path);
    write_assets(again, assets);
    try {
      const AssetDocument same = read_assets(again);
      fuzz::expect(same.scanners == assets.scanners && same.platforms == assets.platforms &&
                   same.scenes == assets.scenes);
    } catch (const FileError&) {
      fuzz::expect(false);
    }
  });
}
