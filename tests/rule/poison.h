/* poison.h - identifiers that firmware/core must not name; included before each of its files by poisoned_identifiers.cmake. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#pragma GCC poison malloc calloc realloc free alloca
#pragma GCC poison printf fprintf sprintf snprintf puts putchar
#pragma GCC poison fopen fread fwrite read write open close time clock_gettime gettimeofday
#pragma GCC poison double
#pragma GCC poison sin cos tan exp log pow atan2 sinf cosf tanf expf logf powf atan2f
