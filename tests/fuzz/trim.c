// Preloaded by routes.py, with glibc: gives free memory back to the system every second, so that what is resident is what the program holds.
#include <malloc.h>
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

static void *trim(void *unused) {
    for (;;) {
        sleep(1);
        malloc_trim(0);
    }
    return unused;
}

__attribute__((constructor)) static void begin(void) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, trim, NULL) != 0)
        abort();
}
