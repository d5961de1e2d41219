// Loaded before a program (LD_PRELOAD), makes one of its calls fail, or kills it there. Calls are counted
// from the beginning of main(), so that with one thread the same run has the same calls in the same order.
//
//   LACQUER_FAULT=KIND:N:ACTION   at the Nth call of a kind:
//     KIND    alloc   malloc, calloc, realloc, aligned_alloc, posix_memalign: ENOMEM
//             tbb     of these, what libtbb asks for, itself or by operator new
//             file    whatever opens, reads, writes, looks at, moves or removes a file or a folder: EIO
//             space   of these, what needs room on the disk: ENOSPC, and so do all that follow
//             thread  pthread_create: EAGAIN
//     ACTION  fail    the call fails
//             kill    SIGKILL, before the call
//             vanish  the folder LACQUER_FAULT_FOLDER is moved away (to its name with .gone), then the call
//             is made
//   LACQUER_FAULT_COUNTS=FILE     how many calls of each kind there were: "alloc 12", a line each
//   LACQUER_FAULT_PLACES=FILE     which of the allocations are the first of their place in the code, as the
//   innermost
//                                 calls on the stack say it: "12", a line each
//   LACQUER_FAULT_TRACE=FILE      a line for each fsync ("fsync PATH") and each rename ("rename FROM TO")
#include <dirent.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

namespace {

enum Kind { kAlloc, kTbb, kFile, kSpace, kThread, kKinds };
constexpr const char* kNames[] = {"alloc", "tbb", "file", "space", "thread"};
constexpr int kErrors[] = {ENOMEM, ENOMEM, EIO, ENOSPC, EAGAIN};

struct Plan {
  int kind = -1;
  long at = 0;
  char action = 'f';
};

std::atomic<bool> active{false};
std::atomic<long> counts[kKinds];
Plan plan;
int trace = -1;
int places = -1;
thread_local bool inside = false;

/// The function behind ours.
template <class F>
F real(const char* name) {
  const bool before = inside;
  inside = true;
  void* found = dlsym(RTLD_NEXT, name);
  inside = before;
  return reinterpret_cast<F>(found);
}

void vanish() {
  const char* folder = getenv("LACQUER_FAULT_FOLDER");
  if (folder == nullptr) return;
  char gone[4096];
  snprintf(gone, sizeof gone, "%s.gone", folder);
  real<int (*)(const char*, const char*)>("rename")(folder, gone);
}

/// Notes an allocation whose stack is new. One thread allocates when this is asked for.
void notePlace(long n) {
  constexpr size_t kRoom = size_t{1} << 18;
  constexpr int kOwn = 2;  // this function and the one that it was called by
  constexpr int kFrames = 12;
  static size_t seen[kRoom];
  void* frames[kOwn + kFrames];
  inside = true;
  const int depth = backtrace(frames, kOwn + kFrames);
  inside = false;
  size_t hash = 1;
  for (int i = kOwn; i < depth; ++i)
    hash = (hash ^ reinterpret_cast<size_t>(frames[i])) * size_t{0x9E3779B97F4A7C15};
  size_t at = hash >> 46;  // 18 bits of it
  for (; seen[at] != 0; at = (at + 1) % kRoom) {
    if (seen[at] == hash) return;
  }
  seen[at] = hash;
  dprintf(places, "%ld\n", n);
}

/// True when this call is to fail.
bool strikes(Kind kind) {
  if (!active.load(std::memory_order_relaxed) || inside) return false;
  const long n = ++counts[kind];
  if (places >= 0 && kind == kAlloc) notePlace(n);
  if (plan.kind != kind || n < plan.at || (n > plan.at && kind != kSpace)) return false;
  if (plan.action == 'k') {
    kill(getpid(), SIGKILL);
    pause();
  }
  if (plan.action == 'v') {
    inside = true;
    if (n == plan.at) vanish();
    inside = false;
    return false;
  }
  errno = kErrors[kind];
  return true;
}

/// Where libtbb lies; looked for only when it matters.
struct Code {
  uintptr_t from = 0, to = 0;
};
Code tbb;

int findTbb(dl_phdr_info* info, size_t, void*) {
  if (strstr(info->dlpi_name, "libtbb.so") == nullptr) return 0;
  tbb.from = info->dlpi_addr;
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const uintptr_t end = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr + info->dlpi_phdr[i].p_memsz;
    if (info->dlpi_phdr[i].p_type == PT_LOAD && end > tbb.to) tbb.to = end;
  }
  return 1;
}

/// An allocation, by whomever; another kind where it is for libtbb.
bool strikesAlloc() {
  const bool bad = strikes(kAlloc);
  if (tbb.to == 0 || inside || !active.load(std::memory_order_relaxed)) return bad;
  constexpr int kFrames = 4;  // this function, malloc, perhaps operator new, and who wants it
  void* frames[kFrames];
  inside = true;
  const int depth = backtrace(frames, kFrames);
  inside = false;
  for (int i = 0; i < depth; ++i) {
    const auto at = reinterpret_cast<uintptr_t>(frames[i]);
    if (at >= tbb.from && at < tbb.to) return strikes(kTbb) || bad;
  }
  return bad;
}

/// A call that needs room, too.
bool strikesSpace() {
  const bool full = strikes(kSpace);
  const bool bad = strikes(kFile);
  if (full && !bad) errno = ENOSPC;
  return full || bad;
}

void note(const char* what, const char* a, const char* b) {
  if (trace < 0 || !active) return;
  char line[8300];
  const int n = snprintf(line, sizeof line, b == nullptr ? "%s %s\n" : "%s %s %s\n", what, a, b);
  static const auto kWrite = real<ssize_t (*)(int, const void*, size_t)>("write");
  if (n > 0) (void)!kWrite(trace, line, static_cast<size_t>(n));
}

void begin() {
  const char* text = getenv("LACQUER_FAULT");
  char kind[16] = "";
  char action[16] = "";
  if (text != nullptr && sscanf(text, "%15[^:]:%ld:%15s", kind, &plan.at, action) == 3) {
    plan.action = action[0];
    for (int k = 0; k < kKinds; ++k) {
      if (strcmp(kind, kNames[k]) == 0) plan.kind = k;
    }
  }
  if (const char* file = getenv("LACQUER_FAULT_TRACE"))
    trace = open(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (const char* file = getenv("LACQUER_FAULT_PLACES")) {
    places = open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  }
  if (plan.kind == kTbb || getenv("LACQUER_FAULT_COUNTS") != nullptr) dl_iterate_phdr(findTbb, nullptr);
  void* frame = nullptr;
  if (places >= 0 || tbb.to != 0) backtrace(&frame, 1);  // loads what it needs
  active = true;
}

void end() {
  active = false;
  const char* file = getenv("LACQUER_FAULT_COUNTS");
  if (file == nullptr) return;
  const int fd = open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  for (int k = 0; k < kKinds; ++k) dprintf(fd, "%s %ld\n", kNames[k], counts[k].load());
  close(fd);
}

int (*program)(int, char**, char**) = nullptr;

int mainBetween(int argc, char** argv, char** environment) {
  begin();
  const int status = program(argc, argv, environment);
  end();
  return status;
}

}  // namespace

// FAULT(RESULT, NAME, FAILURE, HOW, (PARAMETERS), (ARGUMENTS)): a function of libc that may fail.
#define FAULT(result, name, failure, how, parameters, arguments) \
  result name parameters {                                       \
    using F = result(*) parameters;                              \
    static const F kReal = real<F>(#name);                       \
    return how() ? failure : kReal arguments;                    \
  }
#define ONE_FILE() strikes(kFile)

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
  program = main;
  using F = int (*)(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*);
  return real<F>("__libc_start_main")(mainBetween, argc, argv, init, fini, rtld_fini, stack_end);
}

// dlsym() may allocate before it has found the allocator: from here, and never given back.
alignas(16) static char early[1 << 14];
static size_t early_used = 0;

static void* earlyAlloc(size_t size) {
  early_used = (early_used + 15) / 16 * 16;
  if (early_used + size > sizeof early) return nullptr;
  void* at = early + early_used;
  early_used += size;
  return at;
}
static bool isEarly(const void* at) { return at >= early && at < early + sizeof early; }

void* malloc(size_t size) {
  static auto* kReal = static_cast<void* (*)(size_t)>(nullptr);
  if (kReal == nullptr && !inside) kReal = real<void* (*)(size_t)>("malloc");
  if (kReal == nullptr) return earlyAlloc(size);
  return strikesAlloc() ? nullptr : kReal(size);
}
void* calloc(size_t n, size_t size) {
  static auto* kReal = static_cast<void* (*)(size_t, size_t)>(nullptr);
  if (kReal == nullptr && !inside) kReal = real<void* (*)(size_t, size_t)>("calloc");
  if (kReal == nullptr) return earlyAlloc(n * size);
  return strikesAlloc() ? nullptr : kReal(n, size);
}
void free(void* at) {
  static const auto kReal = real<void (*)(void*)>("free");
  if (!isEarly(at)) kReal(at);
}
void* realloc(void* at, size_t size) {
  static const auto kReal = real<void* (*)(void*, size_t)>("realloc");
  if (isEarly(at)) {
    void* to = malloc(size);
    if (to != nullptr) memcpy(to, at, size);
    return to;
  }
  return strikesAlloc() ? nullptr : kReal(at, size);
}
FAULT(
    void*, aligned_alloc, nullptr, [] { return strikesAlloc(); }, (size_t a, size_t n), (a, n))
int posix_memalign(void** to, size_t a, size_t n) {
  static const auto kReal = real<int (*)(void**, size_t, size_t)>("posix_memalign");
  return strikesAlloc() ? ENOMEM : kReal(to, a, n);
}

/// Looks the allocator up before anything else does: dlerror() allocates, and dlsym() within would free what
/// it is at.
__attribute__((constructor)) static void resolve() {
  free(realloc(malloc(1), 2));
  free(calloc(1, 1));
}

int pthread_create(pthread_t* id, const pthread_attr_t* how, void* (*run)(void*), void* with) {
  static const auto kReal =
      real<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
  return strikes(kThread) ? EAGAIN : kReal(id, how, run, with);
}

static mode_t modeOf(int flags, va_list rest) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
}
#define OPEN(name)                                                         \
  int name(const char* path, int flags, ...) {                             \
    static const auto kReal = real<int (*)(const char*, int, ...)>(#name); \
    va_list rest;                                                          \
    va_start(rest, flags);                                                 \
    const mode_t mode = modeOf(flags, rest);                               \
    va_end(rest);                                                          \
    const bool bad = (flags & O_CREAT) != 0 ? strikesSpace() : ONE_FILE(); \
    return bad ? -1 : kReal(path, flags, mode);                            \
  }
OPEN(open)
OPEN(open64)
#define OPENAT(name)                                                            \
  int name(int folder, const char* path, int flags, ...) {                      \
    static const auto kReal = real<int (*)(int, const char*, int, ...)>(#name); \
    va_list rest;                                                               \
    va_start(rest, flags);                                                      \
    const mode_t mode = modeOf(flags, rest);                                    \
    va_end(rest);                                                               \
    const bool bad = (flags & O_CREAT) != 0 ? strikesSpace() : ONE_FILE();      \
    return bad ? -1 : kReal(folder, path, flags, mode);                         \
  }
OPENAT(openat)
OPENAT(openat64)

FAULT(FILE*, fopen, nullptr, strikesSpace, (const char* path, const char* mode), (path, mode))
FAULT(FILE*, fopen64, nullptr, strikesSpace, (const char* path, const char* mode), (path, mode))
FAULT(ssize_t, read, -1, ONE_FILE, (int fd, void* to, size_t n), (fd, to, n))
// What says that something is wrong does not lie on the disk that is.
ssize_t write(int fd, const void* from, size_t n) {
  static const auto kReal = real<ssize_t (*)(int, const void*, size_t)>("write");
  return fd > STDERR_FILENO && strikesSpace() ? -1 : kReal(fd, from, n);
}
FAULT(int, rmdir, -1, ONE_FILE, (const char* path), (path))
FAULT(int, flock, -1, ONE_FILE, (int fd, int how), (fd, how))
FAULT(struct dirent*, readdir, nullptr, ONE_FILE, (DIR * folder), (folder))
FAULT(struct dirent64*, readdir64, nullptr, ONE_FILE, (DIR * folder), (folder))
FAULT(DIR*, opendir, nullptr, ONE_FILE, (const char* path), (path))
FAULT(DIR*, fdopendir, nullptr, ONE_FILE, (int fd), (fd))

}  // extern "C"

// Those that glibc declares as functions that throw nothing.
#undef FAULT
#define FAULT(result, name, failure, how, parameters, arguments) \
  extern "C" result name parameters noexcept {                   \
    using F = result(*) parameters;                              \
    static const F kReal = real<F>(#name);                       \
    return how() ? failure : kReal arguments;                    \
  }
FAULT(FILE*, fdopen, nullptr, ONE_FILE, (int fd, const char* mode), (fd, mode))
FAULT(int, unlink, -1, ONE_FILE, (const char* path), (path))
FAULT(int, unlinkat, -1, ONE_FILE, (int folder, const char* path, int flags), (folder, path, flags))
FAULT(int, mkdir, -1, strikesSpace, (const char* path, mode_t mode), (path, mode))
FAULT(int, stat, -1, ONE_FILE, (const char* path, struct stat* to), (path, to))
FAULT(int, lstat, -1, ONE_FILE, (const char* path, struct stat* to), (path, to))
FAULT(int, fstat, -1, ONE_FILE, (int fd, struct stat* to), (fd, to))
FAULT(int, access, -1, ONE_FILE, (const char* path, int how), (path, how))
FAULT(int, utimensat, -1, ONE_FILE, (int folder, const char* path, const struct timespec times[2], int flags),
      (folder, path, times, flags))
FAULT(void*, mmap, MAP_FAILED, ONE_FILE, (void* at, size_t n, int protection, int flags, int fd, off_t from),
      (at, n, protection, flags, fd, from))
FAULT(char*, realpath, nullptr, ONE_FILE, (const char* path, char* to), (path, to))
FAULT(char*, getcwd, nullptr, ONE_FILE, (char* to, size_t n), (to, n))

extern "C" {

// Streams write and read below what is counted here, so that the stream's own calls stand for them. What a
// failed one has taken is lost, and its error mark set, as after a bad sector.
size_t fwrite(const void* from, size_t size, size_t n, FILE* to) {
  static const auto kReal = real<size_t (*)(const void*, size_t, size_t, FILE*)>("fwrite");
  if (to == stderr || to == stdout || !strikesSpace()) return kReal(from, size, n, to);
  to->_flags |= 0x20;  // _IO_ERR_SEEN
  return 0;
}
size_t fread(void* to, size_t size, size_t n, FILE* from) {
  static const auto kReal = real<size_t (*)(void*, size_t, size_t, FILE*)>("fread");
  if (!ONE_FILE()) return kReal(to, size, n, from);
  from->_flags |= 0x20;
  return 0;
}
int fflush(FILE* stream) {
  static const auto kReal = real<int (*)(FILE*)>("fflush");
  return stream != stderr && stream != stdout && strikesSpace() ? EOF : kReal(stream);
}
int close(int fd) {
  static const auto kReal = real<int (*)(int)>("close");
  const int status = kReal(fd);
  return ONE_FILE() ? -1 : status;
}
int fclose(FILE* stream) {
  static const auto kReal = real<int (*)(FILE*)>("fclose");
  const int status = kReal(stream);
  return strikesSpace() ? EOF : status;
}
int fsync(int fd) {
  static const auto kReal = real<int (*)(int)>("fsync");
  char link[64];
  char path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(link, path, sizeof path - 1);
  path[n > 0 ? n : 0] = '\0';
  note("fsync", path, nullptr);
  return strikesSpace() ? -1 : kReal(fd);
}
int rename(const char* from, const char* to) noexcept {
  static const auto kReal = real<int (*)(const char*, const char*)>("rename");
  note("rename", from, to);
  return strikesSpace() ? -1 : kReal(from, to);
}

}  // extern "C"
