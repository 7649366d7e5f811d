/* The library: everything that hypcheck.h declares. */
#define HYPCHECK_IMPLEMENTATION
#include "hypcheck.h"
