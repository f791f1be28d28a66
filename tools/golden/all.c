/* The list of files of golden vectors. */
#include "vectors.h"

bool vectors_write_all(const char *folder, int *files)
{
    static bool (*const write[])(const char *) = { vectors_contact_frictionless, vectors_contact_friction, vectors_contact_laws, vectors_drag, vectors_repulsion,
                                                   vectors_applied, vectors_lubrication_scalars, vectors_lubrication_resistance,
                                                   vectors_lubrication_forces, vectors_noise_one_body, vectors_noise_pair };
    *files = (int)(sizeof write / sizeof *write);
    for (int k = 0; k < *files; k++)
        if (!write[k](folder))
            return false;
    return true;
}
