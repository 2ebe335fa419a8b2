#define _POSIX_C_SOURCE 200809L // fsync
#include "store.h"

#include "trace_text.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TEXT = 200 };

static const char format_line[] = "traction-store 1";

static void print_body(const store_t *store, char text[TEXT])
{
    uint32_t bits[WHEEL_COUNT];
    memcpy(bits, store->rise_K, sizeof bits);
    (void)snprintf(text, TEXT, "%s\nrise_K %08" PRIx32 " %08" PRIx32 " %08" PRIx32 " %08" PRIx32 "\n", format_line, bits[0], bits[1],
                   bits[2], bits[3]);
}

static void print_all(const store_t *store, char text[TEXT])
{
    print_body(store, text);
    const size_t used = strlen(text);
    (void)snprintf(text + used, TEXT - used, "check %016" PRIx64 "\n", trace_text_hash(TRACE_HASH_BEGIN, text));
}

// The four numbers of the second line; false where there are none. What they are worth, the comparison of the whole text tells.
static bool read_rises(const char *text, uint32_t bits[WHEEL_COUNT])
{
    const char *at = strchr(text, '\n');
    at = at != NULL ? strchr(at, ' ') : NULL;
    for (int i = 0; at != NULL && i < WHEEL_COUNT; i++) {
        char *end = NULL;
        bits[i] = (uint32_t)strtoul(at, &end, 16);
        at = end != at ? end : NULL;
    }
    return at != NULL;
}

bool store_read(const char *path, store_t *store, char message[STORE_MESSAGE])
{
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        (void)snprintf(message, STORE_MESSAGE, "%.160s: cannot be read: %.60s", path, strerror(errno));
        return false;
    }
    char text[TEXT] = "";
    const size_t length = fread(text, 1, sizeof text - 1, file);
    const bool failed = ferror(file) != 0;
    (void)fclose(file);
    text[length] = '\0';
    uint32_t bits[WHEEL_COUNT] = {0};
    store_t found = {{0}};
    char again[TEXT] = "";
    const bool known = !failed && read_rises(text, bits);
    if (known) {
        memcpy(found.rise_K, bits, sizeof bits);
        print_all(&found, again); // what was read must be what these numbers are written as, checksum and all
    }
    if (!known || strcmp(text, again) != 0) {
        (void)snprintf(message, STORE_MESSAGE, "%.160s: is damaged or of another format; it will be written anew", path);
        return false;
    }
    *store = found;
    message[0] = '\0';
    return true;
}

bool store_write(const char *path, const store_t *store, char message[STORE_MESSAGE])
{
    char text[TEXT];
    char temporary[1024];
    print_all(store, text);
    message[0] = '\0';
    const int length = snprintf(temporary, sizeof temporary, "%s.new", path);
    FILE *file = length > 0 && (size_t)length < sizeof temporary ? fopen(temporary, "w") : NULL;
    bool good = file != NULL;
    good = good && fputs(text, file) >= 0 && fflush(file) == 0 && fsync(fileno(file)) == 0;
    if (file != NULL) {
        good = fclose(file) == 0 && good;
        good = good && rename(temporary, path) == 0;
    }
    if (!good) {
        (void)snprintf(message, STORE_MESSAGE, "%.160s: cannot be written: %.60s", path, strerror(errno));
        if (file != NULL) {
            (void)remove(temporary);
        }
    }
    return good;
}
