/* vectors FOLDER: writes the golden vectors of layers 1 and 2 (golden/README.md) into a folder that exists. */
#include "vectors.h"

int main(int argc, char **argv)
{
    int files;
    if (argc != 2 || argv[1][0] == '-') {
        fprintf(stderr, "vectors: say the folder to write to: vectors FOLDER\n");
        return 2;
    }
    if (!vectors_write_all(argv[1], &files))
        return 1;
    printf("vectors: %d files in %s\n", files, argv[1]);
    return 0;
}
