// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: no_point_column_has_this_name
//
// A column of a point that is misspelt does not compile.
#include <pulsecast/io/point_layout.hpp>

using namespace pulsecast::io;

#ifdef SHOULD_NOT_COMPILE
PointLayout layout() { return PointLayout::packed({{"range", NumberType::float32, column("rnage")}}); }
#else
PointLayout layout() { return PointLayout::packed({{"range", NumberType::float32, column("range")}}); }
#endif
