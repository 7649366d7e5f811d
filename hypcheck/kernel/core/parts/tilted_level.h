/* Near the multiplier at which the dual function of a tilted spheroid is greatest. It proves nothing: any result is safe,
   a good one leaves fewer rows to the integers. The poles are p = A1, A2 and B; C's components in the basis that both
   matrices are diagonal in, squared, are P1, P2 and Q. With S = A1 P1/(A1+l)² + A2 P2/(A2+l)² and T = 1 + B Q/(B-l)²,
   Newton's method solves 1/√S = 1/√T, whose sides are straight for a single term: from `l`, by `turns` steps at most. */
HC_TARGET static inline HC_NUMBER HC_NAME(hc_tilted_multiplier)(HC_NUMBER p, HC_NUMBER s, HC_NUMBER t, HC_NUMBER k0, HC_NUMBER k1,
                                                         HC_NUMBER m, HC_NUMBER radius, HC_NUMBER height, HC_NUMBER P1,
                                                         HC_NUMBER l, int turns) {
    const HC_NUMBER root = HC_SQRT(k1 * k1 + HC_SET(4.0) * k0 * t);
    const HC_NUMBER larger = HC_SET(0.5) * (HC_ABS(k1) + root);
    const HC_NUMBER one_pole = larger * HC_INVERSE(t), other_pole = k0 * HC_INVERSE(larger);
    const HC_TRUTH rising = HC_GE(k1, HC_SET(0.0));
    const HC_NUMBER B = HC_SELECT(rising, one_pole, other_pole), A2 = HC_SELECT(rising, other_pole, one_pole);
    const HC_NUMBER G = s * (radius - P1) - p * height, m_plane = m - t * P1, per_root = HC_INVERSE(root);
    const HC_NUMBER a1 = p * P1, a2 = A2 * HC_ABS(G + A2 * m_plane) * per_root, b = B * HC_ABS(B * m_plane - G) * per_root;
    const HC_NUMBER least = HC_SET(-0.999) * HC_MIN(p, A2), greatest = HC_SET(0.999) * B;
    int turn;
    for (turn = 0; turn < turns; turn++) {
        const HC_NUMBER from_A1 = p + l, from_A2 = A2 + l, from_B = B - l, from_both = from_A1 * from_A2;
        const HC_NUMBER inverse = HC_INVERSE(from_both * from_B), inverse_B = inverse * from_B;
        const HC_NUMBER i1 = inverse_B * from_A2, i2 = inverse_B * from_A1, i3 = inverse * from_both;
        const HC_NUMBER S1 = a1 * i1 * i1, S2 = a2 * i2 * i2, T3 = b * i3 * i3;
        const HC_NUMBER S = S1 + S2, T = HC_SET(1.0) + T3, root_S = HC_SQRT(S), root_T = HC_SQRT(T);
        const HC_NUMBER slope = (S1 * i1 + S2 * i2) * T * root_T + T3 * i3 * S * root_S;
        const HC_NUMBER moved = l + (root_S - root_T) * S * T * HC_INVERSE(slope);
        const HC_NUMBER next = HC_MIN(HC_MAX(moved, least), greatest); /* NaN becomes the first pole */
        const HC_NUMBER change = HC_ABS(next - l);
        l = next;
        if (!HC_BITS(HC_GT(change, HC_SET(HC_settled) * HC_ABS(l)))) break;
    }
    return l;
}

/* Tilted rows of ten, by columns as in hc_certified. */
HC_TARGET static hc_bits HC_NAME(hc_tilted)(const double *columns, size_t stride, int count) {
    hc_bits found = {0, 0, 0};
    int at;
    @TILTED_CONSTANTS@
    for (at = 0; at < count; at += HC_WIDTH) {
        @TILTED_INPUTS@
        /* printed from the program "tilted", its first part */
        @TILTED_FORM@
        /* end of the program "tilted", its first part */
        const HC_NUMBER P1 = HC_MAX(cross_squared / level, HC_SET(0.0)); /* 0 for 0/0, where level underflows */
        const uint64_t asked = count - at < HC_WIDTH ? (UINT64_C(1) << (count - at)) - 1 : (UINT64_C(1) << HC_WIDTH) - 1;
        HC_NUMBER l = HC_SET(0.0);
        int taken, turns;
        /* Divisions and roots, two of each a step, are most of what a row costs. Of rows that are uniform in a box about the paper's
           tower, one step decides 98 %, two all but 3 in 10⁵; rows near contact take the others at once. */
        for (taken = 0; taken < HC_TURNS; taken += turns) {
            turns = taken < 2 ? 1 : HC_TURNS - taken;
            l = HC_NAME(hc_tilted_multiplier)(p, s, t, k0, k1, m, radius, height, P1, l, turns);
            /* printed from the program "tilted", the rest */
            @TILTED_AT_MULTIPLIER@
            /* end of the program "tilted", the rest */
            found.plus |= HC_BITS(exterior) << at; /* proved, as all that is decided: no later step takes it back */
            found.minus |= HC_BITS(interior) << at;
            found.decided |= HC_BITS(decided) << at;
            if (!(asked & ~HC_BITS(decided))) break;
        }
    }
    return found;
}

/* As the functions of lines, with half spaces of one orientation. */
@PLANE_FUNCTIONS@
