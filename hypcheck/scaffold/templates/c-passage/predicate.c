/* The predicate under test. As a shared library it needs no adapter:
 *
 *     cc -std=c11 -O2 -ffp-contract=off -shared -fPIC -o hypcheck-c/predicate.so hypcheck-c/predicate.c -lm
 *     hypcheck verify library:hypcheck-c/predicate.so
 */
#include "predicate.h"

#include <math.h>

/* What it claims. Before \"binary\", \"times\":true says that times go with hits, and \"tilt\":true that it is asked about
 * tilted spheroids: predicate_tilted answers all rows then. */
const char *hypcheck_describe(void) {
    return "{\"protocol\":1,\"name\":\"@NAME@\",\"version\":\"0.0.0\",\"language\":\"c\",\"precision\":\"float64\","
           "\"question\":\"passage\",\"binary\":true,\"time\":true}";
}

/* Replace this with your predicate, or with a call of it. The stub takes the spheroid for its centre: right where that
 * goes through the wall, though late, and wrong where only the body touches it.
 *
 * When does the spheroid with semi-axes b, b, d, whose centre goes straight from (x0, y0, z0) at time 0 to (x1, y1, z1) at
 * time 1, first touch x^2/alpha^2 + y^2/alpha^2 - z^2/gamma^2 = 1? From 0 to 1, or -1 where it is clear all the way. */
static double predicate(double alpha, double gamma, double b, double d, double x0, double y0, double z0, double x1,
                        double y1, double z1) {
    (void)b, (void)d;
    double x = x0 / alpha, y = y0 / alpha, z = z0 / gamma;
    double u = (x1 - x0) / alpha, v = (y1 - y0) / alpha, w = (z1 - z0) / gamma;
    double p = u * u + v * v - w * w, q = x * u + y * v - z * w, r = x * x + y * y - z * z - 1;
    double root = sqrt(q * q - p * r); /* p t^2 + 2 q t + r = 0 */
    double s = -(q + copysign(root, q)), one = s / p, other = r / s;
    double first = fmin(one, other), last = fmax(one, other);
    return first >= 0 && first <= 1 ? first : last >= 0 && last <= 1 ? last : -1;
}

/* The same with the spheroid's axis of revolution along (axis_x, axis_y, axis_z) all the way, a vector of any length and
 * sign. The stub ignores it. Asked only with "tilt":true. */
static double predicate_tilted(double alpha, double gamma, double b, double d, double x0, double y0, double z0, double x1,
                               double y1, double z1, double axis_x, double axis_y, double axis_z) {
    (void)axis_x, (void)axis_y, (void)axis_z;
    return predicate(alpha, gamma, b, d, x0, y0, z0, x1, y1, z1);
}

/* The answer, and its time: times is a null pointer unless the description says "times":true. */
static void tell(double first, size_t i, int8_t *hits, double *times) {
    hits[i] = first >= 0;
    if (times) times[i] = hits[i] ? first : NAN;
}

void hypcheck_passage(size_t n, const double *r, int8_t *hits, double *times) {
    for (size_t i = 0; i < n; i++, r += 10)
        tell(predicate(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], r[9]), i, hits, times);
}

void hypcheck_passage_tilted(size_t n, const double *r, int8_t *hits, double *times) {
    for (size_t i = 0; i < n; i++, r += 13)
        tell(predicate_tilted(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], r[9], r[10], r[11], r[12]), i, hits,
             times);
}
