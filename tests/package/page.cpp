// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <iostream>

#include <pulsecast/page/page.hpp>

/// Prints a page without points, to be compared with that of another copy of the library.
int main() { std::cout << pulsecast::page::page_html({.name = "none"}, 0, ""); }
