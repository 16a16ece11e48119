// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

namespace pulsecast::support {

/// Equal to within a share of its size. (doctest's own Approx adds 1 to the size: it takes all numbers far below 1 for
/// equal.)
[[nodiscard]] inline doctest::Approx relative(double value, double share) {
  return doctest::Approx(value).epsilon(share).scale(0);
}

/// True if the compiler contracts a product and a sum into one rounding.
[[nodiscard]] inline bool contracted() {
  volatile double third = 1.0 / 3, three = 3, product = third * three;
  const double a = third, b = three, c = -product;
  return a * b + c != 0;
}

}  // namespace pulsecast::support
