// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A program that knows nothing of pulsecast, and loads the plugin.
#include <dlfcn.h>

#include <iostream>
#include <vector>

int main(int, char** argv) {
  void* const plugin = dlopen(argv[1], RTLD_NOW);
  if (plugin == nullptr) {
    std::cerr << dlerror() << '\n';
    return 1;
  }
  const auto scan = reinterpret_cast<long (*)(const char*, const char*, double*, long)>(dlsym(plugin, "scan"));
  for (const char* sensor : {"mirror", "rosette", "sonar"})
    for (const char* map : {"mesh", "raster"}) {
      std::vector<double> points(3 * 10'000);
      const long count = scan(sensor, map, points.data(), 10'000);
      double sum = 0;
      for (const double coordinate : points) sum += coordinate;
      std::cout << sensor << ' ' << map << ' ' << count << ' ' << std::hexfloat << sum << '\n';
    }
  dlclose(plugin);
}
