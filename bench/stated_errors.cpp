// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Coverage of the limits that runs state of their errors: in each of 30 scenes the share of small surveys whose limits
// hold the errors of all slots.
//
//     bench_stated_errors [SURVEYS [FIRST SCENE [END]]]

#include <cstdio>
#include <cstdlib>

#include "error_scenes.hpp"

int main(int argc, char** argv) {
  using namespace pulsecast;
  const auto argument = [&](int k, std::size_t otherwise) {
    return argc > k ? static_cast<std::size_t>(std::strtoul(argv[k], nullptr, 10)) : otherwise;
  };
  const std::vector<stated::ErrorScene> scenes = stated::error_scenes();
  const std::size_t surveys = argument(1, 200), first = argument(2, 0),
                    end = std::min(argument(3, scenes.size()), scenes.size());
  std::printf("%-24s", "scene");
  for (const ErrorFigureName& figure : error_figure_names)
    std::printf(" %13.*s", static_cast<int>(figure.name.size()), figure.name.data());
  std::printf("\n");
  std::array<stated::Coverage, error_figure_count> all{};
  for (std::size_t s = first; s < end; ++s) {
    const auto held = stated::coverage_of(scenes[s], surveys);
    std::printf("%-24s", scenes[s].name.c_str());
    for (std::size_t f = 0; f < error_figure_count; ++f) {
      std::printf(" %5.1f %7.2g", 100 * held[f].share(), held[f].width());
      all[f].add(held[f]);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  stated::Coverage sum;
  std::printf("%-24s", "all");
  for (const stated::Coverage& each : all) {
    std::printf(" %5.1f %7.2g", 100 * each.share(), each.width());
    sum.add(each);
  }
  std::printf("\n%-24s %5.1f\n", "all figures", 100 * sum.share());
}
