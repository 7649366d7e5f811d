/* ---- the instruction sets: this file, once for each ---- */

/* The file includes itself by the name that HYPCHECK_SELF has. Another file of that name, an earlier edition of this one
   among them, does not define what this text is known by. */
#ifndef HYPCHECK_SELF
#define HYPCHECK_SELF "hypcheck.h"
#endif
#define HC_LEVEL 0
#ifdef __has_include
#if __has_include(HYPCHECK_SELF)
#include HYPCHECK_SELF
#endif
#else
#include HYPCHECK_SELF
#endif
#undef HC_LEVEL
#ifndef @EDITION@
#error "hypcheck: HYPCHECK_SELF does not name this file: where it is not called hypcheck.h, define it as the file's name, in quotation marks"
#else
#if HC_X86
#define HC_LEVEL 1
#include HYPCHECK_SELF
#undef HC_LEVEL
#define HC_LEVEL 2
#include HYPCHECK_SELF
#undef HC_LEVEL
#define HC_LEVEL 3
#include HYPCHECK_SELF
#undef HC_LEVEL
#endif
#if HC_NEON
#define HC_LEVEL 4
#include HYPCHECK_SELF
#undef HC_LEVEL
#endif
