// arm_count - a plugin of qemu-arm (7.2, plugin interface 1) that counts executed instructions between two functions.
//
// usage: qemu-arm -plugin ./libarm_count.so,begin=0xADDRESS,end=0xADDRESS PROGRAM
// At every entry of the function at `end` it prints, on standard error, how many guest instructions ran since the entry of the
// one at `begin`; the bench subtracts what an empty pair costs. The interface is declared here as its documentation states it,
// because Debian packages no header for it.
#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
typedef void (*tb_callback_t)(qemu_plugin_id_t, struct qemu_plugin_tb *);
typedef void (*exec_callback_t)(unsigned int, void *);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *tb);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *tb, size_t index);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *insn);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id, tb_callback_t callback);
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn *insn, exec_callback_t callback, int flags, void *data);
void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn *insn, int op, void *pointer, uint64_t immediate);
int qemu_plugin_install(qemu_plugin_id_t id, const void *info, int argc, char **argv);

int qemu_plugin_version = 1;

static uint64_t executed, started, begin_address, end_address;

static void on_begin(unsigned int cpu, void *data) {
    (void)cpu, (void)data;
    started = executed;
}

static void on_end(unsigned int cpu, void *data) {
    (void)cpu, (void)data;
    fprintf(stderr, "%" PRIu64 "\n", executed - started);
}

static void on_translation(qemu_plugin_id_t id, struct qemu_plugin_tb *tb) {
    (void)id;
    for (size_t i = 0; i < qemu_plugin_tb_n_insns(tb); i++) {
        struct qemu_plugin_insn *insn = qemu_plugin_tb_get_insn(tb, i);
        const uint64_t address = qemu_plugin_insn_vaddr(insn);
        if (address == begin_address) {
            qemu_plugin_register_vcpu_insn_exec_cb(insn, on_begin, 0, NULL);
        }
        if (address == end_address) {
            qemu_plugin_register_vcpu_insn_exec_cb(insn, on_end, 0, NULL);
        }
        qemu_plugin_register_vcpu_insn_exec_inline(insn, 0, &executed, 1); // 0: add
    }
}

int qemu_plugin_install(qemu_plugin_id_t id, const void *info, int argc, char **argv) {
    (void)info;
    for (int i = 0; i < argc; i++) {
        if (strncmp(argv[i], "begin=", 6) == 0) {
            begin_address = strtoull(argv[i] + 6, NULL, 0);
        } else if (strncmp(argv[i], "end=", 4) == 0) {
            end_address = strtoull(argv[i] + 4, NULL, 0);
        }
    }
    if (begin_address == 0 || end_address == 0) {
        fprintf(stderr, "arm_count: give begin=0xADDRESS,end=0xADDRESS\n");
        return 1;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, on_translation);
    return 0;
}
