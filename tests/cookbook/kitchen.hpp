// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>

#include "support/data_folder.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::support {

/// Working folder of a recipe of docs/, with the files that recipes read.
class Kitchen {
 public:
  Kitchen() {
    for (const char* file : {"materials.obj", "materials.mtl", "terrain.tif"})
      std::filesystem::copy(data_folder / file, folder_.path());
    std::filesystem::rename(folder_.path() / "materials.obj", folder_.path() / "tree.obj");
    std::ofstream(folder_.path() / "flight.csv")
        << "time_s,x_m,y_m,z_m,roll_deg,pitch_deg,heading_deg\n0,0,-10,50,0,0,0\n2,0,10,50,0,0,0\n";
    for (const char* file : {"survey.xml", "plane.obj", "plane.mtl"})
      std::filesystem::copy(data_folder.parent_path() / "examples/pulsecast" / file, folder_.path());
    std::filesystem::copy(data_folder.parent_path().parent_path() / "examples/catalogue/data/scanners_tls.xml",
                          folder_.path());
    std::filesystem::copy(data_folder / "urdf/forklift.urdf", folder_.path());
    std::filesystem::copy(data_folder.parent_path().parent_path() / "examples/catalogue/data/sensors",
                          folder_.path() / "sensors");
    std::filesystem::current_path(folder_.path());
  }
  ~Kitchen() { std::filesystem::current_path(before_); }
  Kitchen(const Kitchen&) = delete;
  Kitchen& operator=(const Kitchen&) = delete;

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
  TemporaryFolder folder_;
};

}  // namespace pulsecast::support
