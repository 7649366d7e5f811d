"""The C core under the address and undefined-behaviour sanitizers: every family and level, odd counts, invalid rows."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest

from hypcheck.vectors.families import FAMILIES
from tests.kernel.compiling import needs_compiler, program
from tests.support import inside
from tests.tools.attack.places import near_contact

# Reads rows, answers them as rows and, with the sizes of the first, as scenes of odd lengths, from memory that ends
# where the rows end; one by one they must come out the same.
DRIVER = """
#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"
#include <stdio.h>
#include <stdlib.h>

static int check(size_t n, const double *rows, int8_t *answers) {
    size_t count, i, k;
    hypcheck_classify(n, rows, answers);
    for (count = 0; count < n; count = 2 * count + 1) {
        double *columns[3];
        int8_t *found = (int8_t *)malloc(count + 1);
        for (k = 0; k < 3; k++) {
            columns[k] = (double *)malloc(count ? count * sizeof(double) : 1);
            for (i = 0; i < count; i++) columns[k][i] = rows[7 * i + 4 + k];
        }
        found[count] = 55;
        hypcheck_classify_scene(rows, count, columns[0], columns[1], columns[2], found);
        if (found[count] != 55) return 0;
        for (i = 0; i < count; i++) {
            double row[7];
            memcpy(row, rows, 4 * sizeof *row);
            memcpy(row + 4, rows + 7 * i + 4, 3 * sizeof *row);
            if (found[i] != hypcheck_position(row[0], row[1], row[2], row[3], row[4], row[5], row[6])) return 0;
        }
        for (k = 0; k < 3; k++) free(columns[k]);
        free(found);
    }
    return 1;
}

int main(void) {
    static const char *const levels[] = {"avx512", "avx2", "sse2", "plain"};
    size_t capacity = 1 << 20, n = 0, level;
    double *all = (double *)malloc(7 * sizeof(double) * capacity), *rows, *times;
    int8_t *answers;
    while (fread(all + 7 * n, 7 * sizeof(double), 1, stdin) == 1) n++;
    rows = (double *)malloc(7 * sizeof(double) * n);
    answers = (int8_t *)malloc(n);
    memcpy(rows, all, 7 * sizeof(double) * n);
    for (level = 0; level < 4; level++) {
        if (!hypcheck_use_level(levels[level])) continue;
        if (!check(n, rows, answers)) return 1;
        fwrite(answers, 1, n, stdout);
    }
    times = (double *)malloc(n * sizeof(double)); /* the same numbers as sweeps, which are longer rows */
    hypcheck_passage(7 * n / 10, rows, answers, times);
    hypcheck_passage_tilted(7 * n / 13, rows, answers, times);
    hypcheck_passage_tilted(7 * n / 13, rows, answers, NULL);
    hypcheck_passage_columns(7 * n / 16, 16, rows, answers, times);
    hypcheck_classify_columns(7 * n / 13, 13, rows, answers);
    free(all), free(rows), free(answers), free(times);
    return 0;
}
"""


@needs_compiler
@pytest.mark.parametrize("options", [(), ("-DHYPCHECK_PLAIN", "-DHYPCHECK_SMALL_LIMBS")], ids=["levels", "plain"])
def test_sanitizers_find_no_fault_in_the_c_core(options, tmp_path):
    rows = np.concatenate([*(family.rows(5, 40) for family in FAMILIES.values()), _rows_of_a_scene()])
    bad = rows[: 7 * 4].copy()
    bad[np.arange(28), np.arange(28) % 7] = np.repeat([np.nan, np.inf, -np.inf, -1.0], 7)
    valid = (np.isfinite(bad) & (bad > 0))[:, :4].all(axis=1) & np.isfinite(bad[:, 4:]).all(axis=1)
    expected = np.concatenate([inside.positions(rows), np.where(valid, 0, 127)])
    expected[len(rows) :][valid] = inside.positions(bad[valid])
    sanitizers = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    path = program(tmp_path, DRIVER, "-std=c99", "-O0", "-ffp-contract=off", *sanitizers, *options)
    done = subprocess.run([path], input=np.concatenate([rows, bad]).tobytes(), capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()[:2000]
    found = np.frombuffer(done.stdout, np.int8).reshape(-1, len(expected))
    assert len(found) >= 1
    assert (found == expected).all()


def _rows_of_a_scene():
    """Enough rows that the scene of the first row's sizes gets its lines."""
    rows = near_contact(np.random.default_rng(8), 3000)
    rows[:, :4] = FAMILIES["tower-body"].rows(5, 1)[0, :4]
    return rows
