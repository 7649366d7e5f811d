/* Near the places where spheroids first touch, and the shortest gaps, by columns as in hc_certified. Both are guesses, but for
   the error of the touch, which is proved: hypcheck/kernel/clearance_points.py has the derivations. */
HC_TARGET static void HC_NAME(hc_touches)(const double *columns, size_t stride, int count, hc_touches *found) {
    const HC_NUMBER one = HC_SET(1.0), zero = HC_SET(0.0), tiny = HC_SET(HC_tiny), rounded = HC_SET(HC_rounded);
    int at, turn;
    for (at = 0; at < count; at += HC_WIDTH) {
        const HC_NUMBER alpha = HC_LOAD(columns + at), gamma = HC_LOAD(columns + stride + at);
        const HC_NUMBER b = HC_LOAD(columns + 2 * stride + at), d = HC_LOAD(columns + 3 * stride + at);
        const HC_NUMBER x = HC_LOAD(columns + 4 * stride + at), y = HC_LOAD(columns + 5 * stride + at);
        const HC_NUMBER z = HC_LOAD(columns + 6 * stride + at);
        const HC_NUMBER scale = HC_MAX(HC_ABS(x), HC_ABS(y));
        const HC_TRUTH off = HC_GE(scale, HC_SET(HC_least_offset));
        const HC_NUMBER unit = HC_SELECT(off, scale, one);
        const HC_NUMBER shrunk = one / unit, x_share = HC_SELECT(off, x * shrunk, one), y_share = HC_SELECT(off, y * shrunk, zero);
        const HC_NUMBER length = HC_ROOT(x_share * x_share + y_share * y_share);
        const HC_NUMBER sizes = one / (b * d), per_b = sizes * d, per_d = sizes * b; /* one quotient for two, here and below */
        const HC_NUMBER a = alpha * per_b, c = gamma * per_d, h = HC_ABS(z) * per_d;
        const HC_NUMBER r = HC_SELECT(off, scale * length, scale) * per_b;
        const HC_NUMBER A = a * a, B = c * c, W = A + B, p = HC_MAX(a * r, tiny), q = HC_MAX(c * h, tiny), slope = one / p;
        HC_NUMBER tau = A, sigma = B;
        for (turn = 0; turn < HC_TOUCH_TURNS; turn++) {
            const HC_NUMBER square = sigma * sigma + q * q, cone = HC_ROOT(square), steep = slope * cone;
            const HC_NUMBER step = (sigma - tau * steep) * square / (steep * square + q * q);
            tau = HC_MIN(tau + step, W);
            sigma = HC_MAX(sigma - step, zero);
            if (!HC_BITS(HC_GT(HC_ABS(step), HC_SET(HC_touch_settled) * HC_MIN(tau, sigma)))) break;
        }
        tau = HC_MAX(tau, HC_SET(HC_least_tau)), sigma = HC_MAX(sigma, HC_SET(HC_least_share) * W);
        {
            const HC_TRUTH low_pole = HC_LT(tau, sigma);
            const HC_NUMBER T = HC_SELECT(low_pole, tau, W - sigma), S = HC_SELECT(low_pole, W - tau, sigma);
            const HC_NUMBER poles = one / (T * S), per_T = poles * S, per_S = poles * T;
            const HC_NUMBER to_radius = A * per_T, to_height = B * per_S, radius = to_radius * r, height = to_height * h;
            const HC_NUMBER share = c * h * per_S, part = a * r * per_T, part_square = part * part;
            const HC_NUMBER low = a * HC_ROOT(one + share * share), high = c * HC_ROOT(HC_MAX(part_square - one, zero));
            const HC_NUMBER per_both = one / (low * high), per_high = HC_SELECT(HC_GT(high, zero), low * per_both, HC_SET(HC_NEVER));
            const HC_NUMBER lost = HC_SET(2.0) * rounded * B * part_square * per_high;
            const HC_NUMBER off_low = HC_ABS(low - radius) + rounded * (low + radius);
            const HC_NUMBER off_high = HC_ABS(high - height) + rounded * (high + height) + lost;
            const HC_NUMBER axes = one / (A * B), per_A = axes * B, per_B = axes * A;
            const HC_NUMBER by_low = off_low * off_low * T * per_A, by_high = off_high * off_high * S * per_B;
            const HC_NUMBER least = HC_SELECT(HC_LT(by_high, by_low), by_high, by_low);
            const HC_NUMBER across = HC_ROOT(least * to_radius), up = HC_ROOT(least * to_height);
            const HC_NUMBER error_low = d * up + b * (A * per_B * (height + up) / low) * up;
            const HC_NUMBER error_high = b * across + d * ((HC_SET(2.0) * radius + across) * across * per_high * (B * per_A) + lost);
            const HC_TRUTH other = HC_LT(error_high, error_low);
            const HC_NUMBER rho = HC_SELECT(other, radius, low), zeta = HC_SELECT(other, high, height);
            const HC_NUMBER gone = rho - r, risen = zeta - h, metres = rho * b + zeta * d;
            const HC_NUMBER factor = HC_ROOT(gone * gone + risen * risen), apart = HC_SET(HC_guess) * HC_MAX(factor, one);
            const HC_NUMBER least_factor = factor - apart, most_factor = factor + apart;
            const HC_NUMBER outward = HC_SET(HC_outward) * least_factor, inward = HC_SET(HC_inward) * most_factor;
            const HC_NUMBER error = HC_SELECT(other, error_high, error_low) + HC_SET(2.0) * rounded * metres;
            const HC_NUMBER inverse = one / length;
            HC_STORE(found->low + at, least_factor);
            HC_STORE(found->high + at, most_factor);
            HC_STORE(found->inner_b + at, outward * b);
            HC_STORE(found->inner_d + at, outward * d);
            HC_STORE(found->outer_b + at, inward * b);
            HC_STORE(found->outer_d + at, inward * d);
            HC_STORE(found->radius + at, rho * b);
            HC_STORE(found->height + at, zeta * d);
            HC_STORE(found->cosine + at, x_share * inverse);
            HC_STORE(found->sine + at, y_share * inverse);
            HC_STORE(found->sign + at, HC_SELECT(HC_LT(z, zero), HC_SET(-1.0), one));
            HC_STORE(found->error + at, HC_SET(HC_more_than) * error);
        }
    }
}

HC_TARGET static void HC_NAME(hc_gaps)(const double *columns, size_t stride, int count, const double *sides,
                                       const hc_touches *touches, hc_gaps *found) {
    const HC_NUMBER one = HC_SET(1.0), zero = HC_SET(0.0), half = HC_SET(0.5);
    int at, turn, settled;
    for (at = 0; at < count; at += HC_WIDTH) {
        const HC_NUMBER alpha = HC_LOAD(columns + at), gamma = HC_LOAD(columns + stride + at);
        const HC_NUMBER b = HC_LOAD(columns + 2 * stride + at), d = HC_LOAD(columns + 3 * stride + at);
        const HC_NUMBER x = HC_LOAD(columns + 4 * stride + at), y = HC_LOAD(columns + 5 * stride + at);
        const HC_NUMBER level = HC_ABS(HC_LOAD(columns + 6 * stride + at)), side = HC_LOAD(sides + at);
        const HC_NUMBER r = HC_LOAD(touches->cosine + at) * x + HC_LOAD(touches->sine + at) * y;
        const HC_NUMBER steep = alpha / gamma, bb = b * b, dd = d * d, inverse_gamma = one / gamma;
        HC_NUMBER height = HC_LOAD(touches->height + at), lowest = zero;
        HC_NUMBER highest = HC_SELECT(HC_GT(side, zero), HC_SET(HC_NEVER), level);
        HC_NUMBER cone, slope, v, n, gap, both;
        settled = 0;
        for (turn = 0;; turn++) {
            HC_NUMBER bend, off_place, moved, change;
            HC_TRUTH above, inside;
            const HC_NUMBER share = height * inverse_gamma;
            HC_NUMBER inverse, b_v, bend_v, bend_n;
            cone = HC_ROOT(one + share * share);
            inverse = one / cone;
            slope = steep * share * inverse;
            v = HC_ROOT(bb + dd * slope * slope);
            n = HC_ROOT(one + slope * slope);
            both = one / (v * n); /* one quotient for two */
            gap = (side * (r - slope * level - alpha * inverse) - v) * v * both;
            if (settled || turn == HC_GAP_TURNS) break;
            b_v = n * both;
            bend_v = bb * dd * b_v * b_v * b_v;
            b_v = v * both;
            bend_n = gap * b_v * b_v * b_v;
            off_place = height - level - side * slope * (dd * n * both + gap * b_v);
            bend = one - side * steep * inverse_gamma * inverse * inverse * inverse * (bend_v + bend_n);
            above = HC_GT(off_place, zero);
            lowest = HC_SELECT(above, lowest, height);
            highest = HC_SELECT(above, height, highest);
            moved = height - off_place / bend;
            change = HC_ABS(moved - height);
            settled = !HC_BITS(HC_GT(change, HC_SET(HC_gap_settled) * height));
            inside = HC_AND(HC_AND(HC_GE(moved, lowest), HC_LE(moved, highest)), HC_GT(bend, zero));
            height = HC_SELECT(inside, moved, HC_MIN(half * (lowest + highest), height + height + level));
        }
        {
            const HC_NUMBER rho = alpha * cone, zeta = height, b_v = bb * n * both, d_v = dd * slope * n * both;
            const HC_NUMBER across = rho - (r - side * b_v), up = zeta - (level + side * d_v), largest = HC_MAX(b, d);
            const HC_NUMBER length = HC_ROOT(across * across + up * up), width = v * v * both;
            const HC_NUMBER terms = length + rho + zeta + HC_ABS(x) + HC_ABS(y) + level + largest;
            const HC_NUMBER most = length + HC_SET(HC_points) * terms;
            const HC_NUMBER tried = HC_MIN(gap, most) - HC_SET(HC_guess) * (HC_ABS(gap) + width), thick = width + tried;
            const HC_NUMBER per_width = one / width;
            HC_STORE(found->radius + at, rho);
            HC_STORE(found->height + at, zeta);
            HC_STORE(found->most + at, most);
            HC_STORE(found->width + at, width);
            HC_STORE(found->tried + at, tried);
            HC_STORE(found->inner_b + at, HC_SET(HC_outward) * HC_ROOT(thick * (bb * per_width + tried)));
            HC_STORE(found->inner_d + at, HC_SET(HC_outward) * HC_ROOT(thick * (dd * per_width + tried)));
        }
    }
}
