// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

/// The processes of one machine, which have one copy of a scene among them.
class SceneSharing {
 public:
  virtual ~SceneSharing() = default;
  [[nodiscard]] virtual bool builds() const = 0;  ///< whether this is the one that builds it
  [[nodiscard]] virtual bool shared() const = 0;  ///< whether there are others
  /// What the one that builds says, by all.
  [[nodiscard]] virtual std::string from_builder(std::string text) = 0;
  /// Waits until all have come here.
  virtual void barrier() = 0;
};
