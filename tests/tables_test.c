/* Reading what candidates write: the right numbers from well-formed files, and an exact complaint about all others. */
#include "suite.h"
#include "tables.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/gate-tables-XXXXXX";

static const char *file_with(const char *content, size_t length)
{
    static char path[PATH_LENGTH];
    path_join(path, folder, "file");
    FILE *f = fopen(path, "wb");
    fwrite(content, 1, length, f);
    fclose(f);
    return path;
}

static const char *text(const char *content)
{
    return file_with(content, strlen(content));
}

static void columns_are_found_by_name(void)
{
    struct table t;
    char why[WHY_LENGTH] = "";
    const char *content = "# made by hand\nextra,b,name,a\r\n# in between\n9,2.5e-3, lubrication ,-1\n\n9,+4,drag,1e2";
    check_true(table_read(text(content), "a,b,name$,missing?", &t, why), why);
    check_true(t.rows == 2 && t.columns == 4, "two rows of four columns");
    check_close(table_at(&t, 0, 0), -1, 0, "a");
    check_close(table_at(&t, 0, 1), 2.5e-3, 0, "b");
    check_close(table_at(&t, 1, 0), 100, 0, "a of the last line, which has no line end");
    check_true(strcmp(table_word(&t, 0, 2), "lubrication") == 0 && strcmp(table_word(&t, 1, 2), "drag") == 0, "words");
    check_true(isnan(table_at(&t, 0, 3)), "a missing optional column is NaN");
    check_true(!table_expect_rows(&t, 3, why) && strstr(why, "has 2 rows, expected 3"), why);
    table_free(&t);
    check_true(table_has(text(content), "b") && !table_has(text(content), "c"), "table_has");
}

static void refuses(const char *content, const char *complaint)
{
    struct table t;
    char why[WHY_LENGTH] = "";
    check_true(!table_read(text(content), "a,b", &t, why) && strstr(why, complaint), complaint);
}

static void bad_tables_are_refused_by_line_and_column(void)
{
    struct table t;
    char why[WHY_LENGTH];
    check_true(!table_read("/nowhere/x.csv", "a", &t, why) && strcmp(why, "/nowhere/x.csv is missing") == 0, why);
    refuses("", "is empty: no header line");
    refuses("# only\n# provenance\n", "is empty: no header line");
    refuses("a,c\n1,2\n", ":1: column 'b' is missing from the header");
    refuses("a,a,b\n1,2,3\n", ":1: column 'a' appears twice");
    refuses("a,b\n1,2\n#\n3,four\n", ":4: column 'b' holds 'four', not a finite number");
    refuses("a,b\n1,nan\n", "column 'b' holds 'nan'");
    refuses("a,b\n1,1e999\n", "column 'b' holds '1e999'");
    refuses("a,b\n1,\n2,3\n", ":2: column 'b' holds ''");
    refuses("a,b\n1,2 3\n", "column 'b' holds '2 3'");
    refuses("a,b\n1\n", ":2: fewer columns than the header, which has 2");
    refuses("a,b\n1,2,3\n", ":2: more columns than the header, which has 2");
    check_true(!table_read(file_with("a,b\n1,2\0", 8), "a,b", &t, why) && strstr(why, "is not a text file"), "a zero byte");
}

static const char *npy(const char *header, const double *data, size_t count)
{
    static char content[512];
    const size_t length = strlen(header);
    memcpy(content, "\x93NUMPY\x01\x00", 8);
    content[8] = (char)length;
    content[9] = 0;
    memcpy(content + 10, header, length);
    memcpy(content + 10 + length, data, count * sizeof *data);
    return file_with(content, 10 + length + count * sizeof *data);
}

static void npy_is_read_and_checked(void)
{
    const double data[6] = { 1, 2, 3, 4, 5, 6.5 };
    const char *good = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }    \n";
    size_t shape[2] = { 0, 3 };
    double *read;
    char why[WHY_LENGTH] = "";
    check_true(npy_read(npy(good, data, 6), 2, shape, &read, why), why);
    check_true(shape[0] == 2 && read && read[5] == 6.5, "the last number");
    free(read);
    shape[0] = 4;
    check_true(!npy_read(npy(good, data, 6), 2, shape, &read, why) && strstr(why, "dimension 0 of shape is 2, expected 4"), why);
    shape[0] = 2;
    check_true(!npy_read(npy(good, data, 5), 2, shape, &read, why) && strstr(why, "holds 5 numbers, its shape says 6"), why);
    check_true(!npy_read(npy(good, data, 6), 1, shape, &read, why) && strstr(why, "more than 1 dimensions"), why);
    const double bad[6] = { 1, 2, NAN, 4, 5, 6 };
    check_true(!npy_read(npy(good, bad, 6), 2, shape, &read, why) && strstr(why, "number 2 is not finite"), why);
    check_true(!npy_read(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n", data, 6), 2, shape, &read, why)
                   && strstr(why, "not '<f8'"), why);
    check_true(!npy_read(npy("{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }\n", data, 6), 2, shape, &read, why)
                   && strstr(why, "fortran_order"), why);
    check_true(!npy_read(text("hello"), 2, shape, &read, why) && strstr(why, "is not an NPY file"), why);
}

static void every_particle_needs_its_force(void)
{
    struct forces f;
    char why[WHY_LENGTH] = "";
#define HEAD "state,force,id,fx,fy,fz,tx,ty,tz\n"
    check_true(forces_read(text(HEAD "0,drag,2,7,8,9,1,2,3\n0,drag,1,1,2,3,4,5,6\n"), 1, 2, "drag", &f, why), why);
    check_close(forces_at(&f, 0, "drag", 2)[0], 7, 0, "fx of 2");
    check_close(forces_at(&f, 0, "drag", 1)[5], 6, 0, "tz of 1");
    check_true(forces_at(&f, 0, "contact", 1) == NULL, "a force that is not there");
    forces_free(&f);
    check_true(!forces_read(text(HEAD "0,drag,1,1,2,3,4,5,6\n"), 1, 2, "drag", &f, why)
                   && strstr(why, "no row for state 0, force 'drag', id 2"), why);
    check_true(!forces_read(text(HEAD "0,drag,1,1,2,3,4,5,6\n"), 1, 1, "drag,total", &f, why)
                   && strstr(why, "no rows for force 'total'"), why);
    check_true(!forces_read(text(HEAD "0,drag,1,1,2,3,4,5,6\n0,drag,1,1,2,3,4,5,6\n"), 1, 1, "drag", &f, why)
                   && strstr(why, "has two rows"), why);
    check_true(!forces_read(text(HEAD "3,drag,1,1,2,3,4,5,6\n"), 1, 1, "drag", &f, why) && strstr(why, "state 3 does not exist"),
               why);
    check_true(!forces_read(text(HEAD "0,drag,1.5,1,2,3,4,5,6\n"), 1, 2, "drag", &f, why) && strstr(why, "id 1.5"), why);
}

static void scene_paths(void)
{
    json_t *scene = json_pack("{s{sf}}", "fluid", "viscosity", 0.7);
    check_close(scene_number(scene, "fluid.viscosity", 0), 0.7, 0, "read");
    check_close(scene_number(scene, "fluid.kT", -1), -1, 0, "absent");
    check_true(scene_set(scene, "forces.drag.torque", json_true()) && json_is_true(scene_get(scene, "forces.drag.torque")),
               "objects on the way are made");
    json_decref(scene);
}

static void written_states_keep_every_bit(void)
{
    const struct state_row row = { .state = 0, .id = 1, .species = 2, .x = { 1.0 / 3, -0.1, 1e-300 }, .w = { 0, 0, 2.0 / 7 } };
    char path[PATH_LENGTH], why[WHY_LENGTH] = "";
    struct table t;
    path_join(path, folder, "states.csv");
    check_true(states_write(path, &row, 1, why) && table_read(path, "x,y,z,wz,species", &t, why), why);
    check_true(table_at(&t, 0, 0) == 1.0 / 3 && table_at(&t, 0, 2) == 1e-300 && table_at(&t, 0, 3) == 2.0 / 7, "17 digits");
    table_free(&t);
}

static void first(void)
{
    check_true(mkdtemp(folder) != NULL, "a folder to work in");
}

static void last(void)
{
    check_true(folder_remove(folder) && access(folder, F_OK) != 0, "the folder is gone");
}

static const struct unit_test tests[] = {
    { "work folder", first },
    { "columns are found by name", columns_are_found_by_name },
    { "bad tables are refused by line and column", bad_tables_are_refused_by_line_and_column },
    { "NPY is read and checked", npy_is_read_and_checked },
    { "every particle needs its force", every_particle_needs_its_force },
    { "paths in a scene", scene_paths },
    { "written states keep every bit", written_states_keep_every_bit },
    { "work folder removed", last },
    { NULL, NULL },
};

const struct suite tables_suite = { "tables", tests };
