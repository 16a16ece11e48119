// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

/// Processes of one machine that share one copy of a scene.
class SceneSharing {
 public:
  virtual ~SceneSharing() = default;
  [[nodiscard]] virtual bool builds() const = 0;  ///< true: this process builds the scene
  [[nodiscard]] virtual bool shared() const = 0;  ///< true: there are other processes
  /// Text of the building process, on all.
  [[nodiscard]] virtual std::string from_builder(std::string text) = 0;
  /// Waits for all processes.
  virtual void barrier() = 0;
};
