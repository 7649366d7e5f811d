// What predicate.cpp offers to adapter.cpp, and, built as a shared library, to hypcheck itself.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {
// What the predicate claims, as one line of JSON.
const char *hypcheck_describe();

// Answers n rows of alpha, gamma, b, d, x, y, z.
void hypcheck_classify(std::size_t n, const double *rows, std::int8_t *positions);

// Answers n rows of alpha, gamma, b, d, x, y, z, axis_x, axis_y, axis_z, if the predicate claims "tilt":true.
void hypcheck_classify_tilted(std::size_t n, const double *rows, std::int8_t *positions);
}
