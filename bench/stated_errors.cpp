// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Coverage of the limits that runs state of their errors: in each of 30 scenes the share of small surveys whose limits
// hold the errors of all slots [%], and half the width of the limits by the value. Sums are of figures that occur.
//
//     bench_stated_errors [SURVEYS [FIRST SCENE [END]]]

#include <cstdio>
#include <cstdlib>

#include "error_scenes.hpp"

namespace {

using Row = std::array<stated::Coverage, pulsecast::error_figure_count>;

void print(const char* name, const Row& row) {
  std::printf("%-24s", name);
  for (const stated::Coverage& each : row) std::printf(" %5.1f %7.2g", 100 * each.share(), each.width());
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int k, std::size_t otherwise) {
    return argc > k ? static_cast<std::size_t>(std::strtoul(argv[k], nullptr, 10)) : otherwise;
  };
  const std::vector<stated::ErrorScene> scenes = stated::error_scenes();
  const std::size_t surveys = argument(1, 200), first = argument(2, 0),
                    end = std::min(argument(3, scenes.size()), scenes.size());
  std::printf("%-24s", "scene");
  for (const std::string_view figure : pulsecast::error_figure_names)
    std::printf(" %13.*s", static_cast<int>(figure.size()), figure.data());
  std::printf("\n");
  Row all{};
  stated::Coverage sum;
  double least = 1;
  for (std::size_t s = first; s < end; ++s) {
    const Row held = stated::coverage_of(scenes[s], surveys);
    print(scenes[s].name.c_str(), held);
    for (std::size_t f = 0; f < held.size(); ++f) {
      least = std::min(least, held[f].share());
      if (!held[f].occurs) continue;
      all[f].add(held[f]);
      sum.add(held[f]);
    }
  }
  print("all", all);
  std::printf("all figures %.2f, lowest %.1f\n", 100 * sum.share(), 100 * least);
}
