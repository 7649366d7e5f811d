/* The predicate under test. As a shared library it needs no adapter:
 *
 *     cc -std=c11 -O2 -ffp-contract=off -shared -fPIC -o hypcheck-c/predicate.so hypcheck-c/predicate.c
 *     hypcheck verify library:hypcheck-c/predicate.so
 */
#include "predicate.h"

/* What it claims. "question" may be position (+1 exterior, 0 contact, -1 interior), exterior, interior or contact
 * (1 yes, 0 no). Table 2 claims to be right where (gamma/d)^2 >= alpha/b; without "domain" all sizes are asked.
 * With \"tilt\":true before \"binary\" it is asked about tilted spheroids: predicate_tilted answers all rows then. */
const char *hypcheck_describe(void) {
    return "{\"protocol\":1,\"name\":\"@NAME@\",\"version\":\"0.0.0\",\"language\":\"c\",\"precision\":\"float64\","
           "\"question\":\"exterior\",\"domain\":{\"regimes\":[\"c2>=a\"]},\"binary\":true,\"time\":true}";
}

/* Replace this with your predicate, or with a call of it. The stub is Table 2 (Procedure 1) of "Algorithms for
 * Determining Relative Position between Spheroids and Hyperboloids with One Sheet": right in the paper's scenes, wrong on
 * the ring, where its discriminant vanishes far from the surface.
 *
 * Is the spheroid with semi-axes b, b, d and centre (x, y, z) exterior to x^2/alpha^2 + y^2/alpha^2 - z^2/gamma^2 = 1? */
static int predicate(double alpha, double gamma, double b, double d, double x, double y, double z) {
    double A = (alpha / b) * (alpha / b);
    double B = (gamma / d) * (gamma / d);
    double c0 = -(A * B);
    double C = c0 + A - B;

    double P = (x * x + y * y) / (b * b);
    double Q = (z / d) * (z / d);
    double c1 = C + B * P - A * Q;
    double c2 = A - B + 1 - P - Q;
    double delta =
        -4 * (c2 * c2 * c2) * c0 + (c2 * c1) * (c2 * c1) + 18 * c2 * c1 * c0 - 4 * (c1 * c1 * c1) - 27 * (c0 * c0);
    return delta > 0 && c2 < 0 && c1 > 0;
}

/* The same with the spheroid's axis of revolution along (axis_x, axis_y, axis_z), a vector of any length and sign, upright
 * where axis_x = axis_y = 0. The stub ignores it: wrong as soon as the spheroid is tilted. Asked only with "tilt":true. */
static int predicate_tilted(double alpha, double gamma, double b, double d, double x, double y, double z, double axis_x,
                            double axis_y, double axis_z) {
    (void)axis_x, (void)axis_y, (void)axis_z;
    return predicate(alpha, gamma, b, d, x, y, z);
}

void hypcheck_classify(size_t n, const double *rows, int8_t *positions) {
    for (size_t i = 0; i < n; i++, rows += 7)
        positions[i] = (int8_t)predicate(rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6]);
}

void hypcheck_classify_tilted(size_t n, const double *rows, int8_t *positions) {
    for (size_t i = 0; i < n; i++, rows += 10)
        positions[i] = (int8_t)predicate_tilted(rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7],
                                                rows[8], rows[9]);
}
