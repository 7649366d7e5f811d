
/* ---- spheroids whose axis leans: the public functions ---- */

void hypcheck_classify_tilted(size_t n, const double *rows10, int8_t *positions) {
    size_t i;
    for (i = 0; i < n; i++) {
        const double *const row = rows10 + 10 * i;
        positions[i] = (int8_t)(hc_tilted_valid(row) ? hc_exact_tilted_position(row) : 127);
    }
}

void hypcheck_classify_tilted_scene(const double sizes[4], const double axis[3], size_t n, const double *x,
                                    const double *y, const double *z, int8_t *positions) {
    size_t i;
    for (i = 0; i < n; i++) {
        const double row[10] = {sizes[0], sizes[1], sizes[2], sizes[3], x[i], y[i], z[i], axis[0], axis[1], axis[2]};
        positions[i] = (int8_t)(hc_tilted_valid(row) ? hc_exact_tilted_position(row) : 127);
    }
}
