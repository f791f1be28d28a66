/* audit [VECTORS [HEADER]]: everything once more, by other derivations (audit.h); golden/vectors and validation/theory/theory.h unless said. */
#include "audit.h"

int main(int argc, char **argv)
{
    audit_vectors(argc > 1 ? argv[1] : "golden/vectors");
    audit_two_spheres();
    audit_spheres();
    audit_collisions();
    audit_motion();
    audit_crowds();
    return audit_close(argc > 2 ? argv[2] : "validation/theory/theory.h");
}
