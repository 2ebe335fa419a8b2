// board_seed FILE - credits the kernel's pool of randomness with the bytes of FILE, as a board does that kept a seed over its last
// power-off: a machine without any device of noise would otherwise wait 20 s for its ssh server's first random number.
#include <fcntl.h>
#include <linux/random.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { SEED = 64 };

int main(int argc, char **argv) {
    union {
        struct rand_pool_info info;
        char room[sizeof(struct rand_pool_info) + SEED];
    } pool;
    const int from = argc == 2 ? open(argv[1], O_RDONLY | O_CLOEXEC) : -1, to = open("/dev/urandom", O_WRONLY | O_CLOEXEC);
    const ssize_t got = from >= 0 ? read(from, pool.info.buf, SEED) : -1;
    pool.info.entropy_count = 8 * (int)got;
    pool.info.buf_size = (int)got;
    if (got <= 0 || to < 0 || ioctl(to, RNDADDENTROPY, &pool.info) != 0) {
        perror("board_seed");
        return 1;
    }
    return 0;
}
