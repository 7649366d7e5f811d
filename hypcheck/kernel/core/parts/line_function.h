HC_TARGET static void HC_NAME(hc_@NAME@)(const hc_scene *scene, int blocks, const double *x_of, const double *y_of,
                                          const double *z_of, int fetch, hc_signs *signs, uint64_t *left) {
    int block;
    @FIELDS@
    for (block = 0; block < blocks; block++) {
        const int base = HC_BLOCK * block;
        HC_NUMBER sum = HC_SET(0.0);
        hc_bits found = {0, 0, 0};
        int at;
        if (fetch)
            for (at = 0; at < HC_BLOCK; at += 8) {
                HC_FETCH(x_of, base + at + HC_AHEAD);
                HC_FETCH(y_of, base + at + HC_AHEAD);
                HC_FETCH(z_of, base + at + HC_AHEAD);
            }
        for (at = 0; at < HC_BLOCK; at += HC_WIDTH) {
            const HC_NUMBER x = HC_LOAD(x_of + base + at);
            const HC_NUMBER y = HC_LOAD(y_of + base + at);
            const HC_NUMBER z = HC_LOAD(z_of + base + at);
            /* printed from the program "@PROGRAM@" */
            @STEPS@
            /* end of the program "@PROGRAM@" */
            sum = sum + R_plus_T;
            @RESULTS@
        }
        signs[block].plus = found.plus;
        signs[block].minus = found.minus;
        left[block] = ~(HC_NAME(hc_all_below)(sum, HC_cap) ? found.decided : 0);
    }
}
