"""The C core for tilted spheroids under the sanitizers: every level, odd counts, longest numbers, bad rows."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest

from tests.kernel.compiling import needs_compiler, program
from tests.kernel.test_tilted_integers import RINGS, small_rows, wide_rows
from tests.support.inside import positions
from tests.tools.attack.tilted_places import at_the_limits, far, near_contact

pytestmark = pytest.mark.slow

# Reads rows of ten, answers them and, with sizes and axis of some, scenes of odd lengths, from memory that ends where
# the rows end; one by one they must come out the same.
DRIVER = """
#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"
#include <stdio.h>
#include <stdlib.h>

static int check(size_t n, const double *rows, const double *first, size_t count) {
    double *columns[3];
    int8_t *found = (int8_t *)malloc(count + 1), one;
    size_t i, k;
    for (k = 0; k < 3; k++) {
        columns[k] = (double *)malloc(count ? count * sizeof(double) : 1);
        for (i = 0; i < count; i++) columns[k][i] = rows[10 * (i % n) + 4 + k];
    }
    found[count] = 55;
    hypcheck_classify_tilted_scene(first, first + 7, count, columns[0], columns[1], columns[2], found);
    if (found[count] != 55) return 0;
    for (i = 0; i < count; i += 1 + i / 16) {
        double row[10];
        memcpy(row, first, sizeof row);
        for (k = 0; k < 3; k++) row[4 + k] = columns[k][i];
        hypcheck_classify_tilted(1, row, &one);
        if (found[i] != one) return 0;
    }
    for (k = 0; k < 3; k++) free(columns[k]);
    free(found);
    return 1;
}

int main(void) {
    static const char *const levels[] = {"avx512", "avx2", "sse2", "plain"};
    static const size_t counts[] = {0, 1, 63, 65, 1025, 2100};
    size_t capacity = 1 << 16, n = 0, level, k;
    double *all = (double *)malloc(10 * sizeof(double) * capacity), *rows;
    int8_t *answers;
    while (fread(all + 10 * n, 10 * sizeof(double), 1, stdin) == 1) n++;
    rows = (double *)malloc(10 * sizeof(double) * n);
    answers = (int8_t *)malloc(n);
    memcpy(rows, all, 10 * sizeof(double) * n);
    for (level = 0; level < 4; level++) {
        if (!hypcheck_use_level(levels[level])) continue;
        hypcheck_classify_tilted(n, rows, answers);
        for (k = 0; k < 6; k++)
            if (!check(n, rows, rows + 10 * (7 * k % n), counts[k])) return 1;
        fwrite(answers, 1, n, stdout);
    }
    free(all), free(rows), free(answers);
    return 0;
}
"""


@needs_compiler
@pytest.mark.parametrize("options", [(), ("-DHYPCHECK_PLAIN", "-DHYPCHECK_SMALL_LIMBS")], ids=["levels", "plain"])
def test_sanitizers_find_no_fault_in_the_c_core_for_tilted_spheroids(options, tmp_path):
    random = np.random.default_rng(8)
    longest = [1.7e308, 5e-324, 1.7e308, 1e-323, 1.7e308, 5e-324, 1.7e308, 5e-324, 1.7e308, 1e-323]
    rows = np.array([*(row for row, _ in RINGS), *small_rows(41, 60), *wide_rows(42, 20), longest])
    rows = np.concatenate([rows, near_contact(random, 200), at_the_limits(random, 60), far(random, 40)])
    bad = np.repeat(rows[:10], 2, axis=0)
    bad[np.arange(20), np.arange(20) % 10] = np.repeat([np.nan, -np.inf], 10)
    bad[:2, 7:] = 0.0
    expected = [*positions(rows).tolist(), *[127] * 20]
    sanitizers = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    path = program(tmp_path, DRIVER, "-std=c99", "-O0", "-ffp-contract=off", *sanitizers, *options)
    data = np.concatenate([rows, bad]).tobytes()
    done = subprocess.run([path], input=data, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()[:2000]
    found = np.frombuffer(done.stdout, dtype=np.int8).reshape(-1, len(expected))
    assert len(found) > 0
    assert (found == expected).all()
