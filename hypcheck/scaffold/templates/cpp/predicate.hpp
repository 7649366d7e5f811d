// What predicate.cpp offers to adapter.cpp, and, built as a shared library, to hypcheck itself.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {
// What the predicate claims, as one line of JSON.
const char *hypcheck_describe();

@position@
// Answers n rows of alpha, gamma, b, d, x, y, z.
void hypcheck_classify(std::size_t n, const double *rows, std::int8_t *positions);

// Answers n rows of alpha, gamma, b, d, x, y, z, axis_x, axis_y, axis_z, if the predicate claims "tilt":true.
void hypcheck_classify_tilted(std::size_t n, const double *rows, std::int8_t *positions);
@passage@
// Answers n rows of alpha, gamma, b, d, x0, y0, z0, x1, y1, z1; times may be a null pointer, and is NaN without a hit.
void hypcheck_passage(std::size_t n, const double *rows, std::int8_t *hits, double *times);

// Answers n rows with axis_x, axis_y, axis_z behind, if the predicate claims "tilt":true.
void hypcheck_passage_tilted(std::size_t n, const double *rows, std::int8_t *hits, double *times);
@end@
}
