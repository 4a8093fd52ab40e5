// Loaded before the C library (LD_PRELOAD): lets one call of a kind fail, once, after main has begun.
//   SUNFLECK_FAULT=KIND:N        the Nth call, from 1; 0 only counts. KIND: open, read, write, rename, fsync, malloc
//   SUNFLECK_FAULT_COUNT=FILE    how many calls of the kind there were, written at the end
// Streams 0 to 2 are left alone. "write" is pwrite, ftruncate and a full disk too; "read" is pread; "malloc" is calloc, realloc and
// aligned memory; failing calls set ENOSPC, EIO, EMFILE or ENOMEM.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum kind { none, k_open, k_read, k_write, k_rename, k_fsync, k_malloc };

static enum kind armed = none;
static long wanted = 0;
static atomic_long calls = 0;

static int fails(enum kind kind) {
  if (kind != armed) return 0;
  return atomic_fetch_add(&calls, 1) + 1 == wanted;
}

static void* next_symbol(const char* name) {
  return dlsym(RTLD_NEXT, name);
}

// ---- files

static int open_at(int folder, const char* path, int flags, mode_t mode) {
  if (fails(k_open)) {
    errno = EMFILE;
    return -1;
  }
  return (int)syscall(SYS_openat, folder, path, flags, mode);
}

#define MODE_ARGUMENT(flags)                        \
  mode_t mode = 0;                                  \
  if ((flags) & (O_CREAT | __O_TMPFILE)) {          \
    va_list arguments;                              \
    va_start(arguments, flags);                     \
    mode = va_arg(arguments, mode_t);               \
    va_end(arguments);                              \
  }

int open(const char* path, int flags, ...) {
  MODE_ARGUMENT(flags)
  return open_at(AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  MODE_ARGUMENT(flags)
  return open_at(AT_FDCWD, path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  MODE_ARGUMENT(flags)
  return open_at(folder, path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) {
  MODE_ARGUMENT(flags)
  return open_at(folder, path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) {
  static FILE* (*real)(const char*, const char*);
  if (fails(k_open)) {
    errno = EMFILE;
    return NULL;
  }
  if (!real) real = (FILE * (*)(const char*, const char*)) next_symbol("fopen");
  return real(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  return fopen(path, mode);
}

static int fails_on(enum kind kind, int descriptor, int error) {
  if (descriptor <= 2 || !fails(kind)) return 0;
  errno = error;
  return 1;
}
ssize_t read(int descriptor, void* bytes, size_t count) {
  return fails_on(k_read, descriptor, EIO) ? -1 : syscall(SYS_read, descriptor, bytes, count);
}
ssize_t pread64(int descriptor, void* bytes, size_t count, off64_t at) {
  return fails_on(k_read, descriptor, EIO) ? -1 : syscall(SYS_pread64, descriptor, bytes, count, at);
}
ssize_t pread(int descriptor, void* bytes, size_t count, off_t at) {
  return pread64(descriptor, bytes, count, at);
}
ssize_t write(int descriptor, const void* bytes, size_t count) {
  return fails_on(k_write, descriptor, ENOSPC) ? -1 : syscall(SYS_write, descriptor, bytes, count);
}
ssize_t writev(int descriptor, const struct iovec* parts, int count) {
  return fails_on(k_write, descriptor, ENOSPC) ? -1 : syscall(SYS_writev, descriptor, parts, count);
}
ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t at) {
  return fails_on(k_write, descriptor, ENOSPC) ? -1 : syscall(SYS_pwrite64, descriptor, bytes, count, at);
}
ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t at) {
  return pwrite64(descriptor, bytes, count, at);
}
int ftruncate64(int descriptor, off64_t length) {
  return fails_on(k_write, descriptor, ENOSPC) ? -1 : (int)syscall(SYS_ftruncate, descriptor, length);
}
int ftruncate(int descriptor, off_t length) {
  return ftruncate64(descriptor, length);
}
int fsync(int descriptor) {
  return fails_on(k_fsync, descriptor, EIO) ? -1 : (int)syscall(SYS_fsync, descriptor);
}
int rename(const char* from, const char* to) {
  if (fails(k_rename)) {
    errno = EACCES;
    return -1;
  }
  return (int)syscall(SYS_renameat, AT_FDCWD, from, AT_FDCWD, to);
}

// ---- memory: glibc's own names, since dlsym asks for memory itself

extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);

static int no_memory(void) {
  if (!fails(k_malloc)) return 0;
  errno = ENOMEM;
  return 1;
}
void* malloc(size_t size) {
  return no_memory() ? NULL : __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  return no_memory() ? NULL : __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) {
  return no_memory() ? NULL : __libc_realloc(old, size);
}
void* memalign(size_t alignment, size_t size) {
  return no_memory() ? NULL : __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  return memalign(alignment, size);
}
int posix_memalign(void** out, size_t alignment, size_t size) {
  void* got = memalign(alignment, size);
  if (!got) return ENOMEM;
  *out = got;
  return 0;
}

// ---- from main on

static int (*program)(int, char**, char**);

static int watched(int count, char** words, char** environment) {
  static const char* const names[] = {"", "open", "read", "write", "rename", "fsync", "malloc"};
  const char* fault = getenv("SUNFLECK_FAULT");
  const char* colon = fault ? strchr(fault, ':') : NULL;
  if (colon) {
    wanted = atol(colon + 1);
    for (int k = k_open; k <= k_malloc; ++k)
      if (strncmp(fault, names[k], (size_t)(colon - fault)) == 0 && names[k][colon - fault] == '\0') armed = (enum kind)k;
  }
  const int code = program(count, words, environment);
  armed = none;
  const char* file = getenv("SUNFLECK_FAULT_COUNT");
  if (file) {
    char text[32];
    const int length = snprintf(text, sizeof text, "%ld\n", (long)calls);
    const int out = (int)syscall(SYS_openat, AT_FDCWD, file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (out >= 0) {
      if (syscall(SYS_write, out, text, length) != length) abort();
      syscall(SYS_close, out);
    }
  }
  return code;
}

int __libc_start_main(int (*main_)(int, char**, char**), int count, char** words, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void* stack_end) {
  int (*real)(int (*)(int, char**, char**), int, char**, void (*)(void), void (*)(void), void (*)(void), void*) =
      (int (*)(int (*)(int, char**, char**), int, char**, void (*)(void), void (*)(void), void (*)(void), void*))next_symbol("__libc_start_main");
  program = main_;
  return real(watched, count, words, init, fini, rtld_fini, stack_end);
}
