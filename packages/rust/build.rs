//! Compiles the C header, which needs a C99 compiler and no library.

fn main() {
    let in_package = std::path::Path::new("src/hypcheck.h");
    let folder = if in_package.exists() { "src" } else { "../../hypcheck/kernel/core" }; // the second in the repository
    println!("cargo:rerun-if-changed={folder}/hypcheck.h");
    println!("cargo:rerun-if-changed=src/hypcheck.c");
    cc::Build::new()
        .file("src/hypcheck.c")
        .include(folder)
        .opt_level(2) // unoptimised, it would be ten times slower than the Rust around it
        .warnings(false)
        .compile("hypcheck");
}
