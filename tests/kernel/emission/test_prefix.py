"""Two kernels and hypcheck.h in one program: different names, one linker."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from hypcheck.cli.main import main
from tests.kernel.emission.building import needs
from tests.support.inside import HEADER

ROWS = "{2, 17.8, 0.25, 0.15, 3, 0, 5}"
"""A row of the tower's sizes, outside."""

PROGRAM = """
#include "hypcheck.h"
#include <stdio.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif
void tower_classify(size_t n, const double *rows, int8_t *positions);
void tower_classify_scene(const double sizes[4], size_t n, const double *x, const double *y, const double *z,
                          int8_t *positions);
const char *tower_describe(void);
void forest_2_classify(size_t n, const double *rows, int8_t *positions);
const char *forest_2_describe(void);
#ifdef __cplusplus
}
#endif

int main(void)
{
    const double row[7] = ROW;
    int8_t found[4];
    hypcheck_classify(1, row, found);
    tower_classify(1, row, found + 1);
    tower_classify_scene(row, 1, row + 4, row + 5, row + 6, found + 2);
    forest_2_classify(1, row, found + 3);
    printf("%d %d %d %d ", found[0], found[1], found[2], found[3]);
    puts(strcmp(tower_describe(), forest_2_describe()) != 0 ? "differ" : "same");
    return 0;
}
""".replace("ROW", ROWS)
IMPLEMENTATION = '#define HYPCHECK_IMPLEMENTATION\n#include "hypcheck.h"\n'
EXPECTED = "1 0 0 2 differ\n"
"""The header says exterior; the tower's kernel that it is not interior; the forest has no such sizes."""


def emitted(path, scene, language, prefix):
    arguments = ["emit", "--scene", scene, "--language", language, "--prefix", prefix, "--output", str(path)]
    assert main(arguments) == 0
    return str(path)


@pytest.mark.parametrize(("language", "suffix", "compiler"), [("c", "c", "cc"), ("cpp", "cpp", "c++")])
def test_two_emitted_kernels_and_the_header_link_into_one_program(language, suffix, compiler, tmp_path):
    if shutil.which(compiler) is None:
        pytest.skip(f"there is no {compiler}")
    sources = [
        emitted(tmp_path / f"{prefix}.{suffix}", scene, language, prefix)
        for scene, prefix in (("tower", "tower"), ("forest", "forest_2"))
    ]
    for name, text in (("main", PROGRAM), ("implementation", IMPLEMENTATION)):
        (tmp_path / f"{name}.{suffix}").write_text(text, encoding="utf-8")
        sources.append(str(tmp_path / f"{name}.{suffix}"))
    command = [compiler, "-Wall", "-Werror", f"-I{HEADER.parent}", *sources, "-lm", "-o", str(tmp_path / "program")]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    assert subprocess.run([tmp_path / "program"], capture_output=True, text=True, check=True).stdout == EXPECTED


@needs("rust")
def test_two_emitted_rust_kernels_can_be_modules_of_one_crate(tmp_path):
    for prefix, scene in (("tower", "tower"), ("forest", "forest")):
        emitted(tmp_path / f"{prefix}.rs", scene, "rust", prefix)
    row = ROWS.replace("{", "[").replace("}", "]").replace(",", ".0,", 1).replace("3, 0, 5", "3.0, 0.0, 5.0")
    told = 'println!("{} {}", tower::position(&row), forest::position(&row));'
    text = f"#![allow(dead_code)]\nmod forest;\nmod tower;\nfn main() {{\n    let row = {row};\n    {told}\n}}\n"
    (tmp_path / "main.rs").write_text(text, encoding="utf-8")
    command = ["rustc", "--edition", "2021", "main.rs", "-o", "program"]
    built = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    assert subprocess.run([tmp_path / "program"], capture_output=True, text=True, check=True).stdout == "0 2\n"
