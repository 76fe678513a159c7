/* SPDX-License-Identifier: MIT */
/* A triangle by hand in the formats that assimp reads and does not write. Those of which
 * only the head is here lead the fuzzer into their reader, no more. */
#include "fuzz.h"

#include <string.h>

#include "seeds.h"

static const struct {
    const char *name, *text;
} texts[] = {
    {"m.off", "OFF\n4 2 0\n-1 0 1\n1 0 1\n1 0 -1\n-1 1 -1\n3 0 1 2\n3 0 2 3\n"},
    {"m.raw", "triangle\n0 0 0 1 0 0 0 1 0\n"},
    {"m.ac", "AC3Db\nMATERIAL \"m\" rgb 1 1 1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 "
             "trans 0\nOBJECT world\nkids 1\nOBJECT poly\nname \"t\"\nloc 0 1 0\n"
             "numvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x0\nmat 0\nrefs 3\n"
             "0 0 0\n1 1 0\n2 0 1\nkids 0\n"},
    {"m.ase", "*3DSMAX_ASCIIEXPORT 200\n*GEOMOBJECT {\n*NODE_NAME \"t\"\n*NODE_TM {\n"
              "*NODE_NAME \"t\"\n*TM_ROW0 1 0 0\n*TM_ROW1 0 1 0\n*TM_ROW2 0 0 1\n"
              "*TM_ROW3 0 0 0\n}\n*MESH {\n*TIMEVALUE 0\n*MESH_NUMVERTEX 3\n"
              "*MESH_NUMFACES 1\n*MESH_VERTEX_LIST {\n*MESH_VERTEX 0 0 0 0\n"
              "*MESH_VERTEX 1 1 0 0\n*MESH_VERTEX 2 0 1 0\n}\n*MESH_FACE_LIST {\n"
              "*MESH_FACE 0: A: 0 B: 1 C: 2 AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 1 "
              "*MESH_MTLID 0\n}\n}\n}\n"},
    {"m.bvh", "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition "
              "Zposition\nJOINT b\n{\nOFFSET 0 1 0\nCHANNELS 1 Xrotation\nEnd Site\n{\n"
              "OFFSET 0 1 0\n}\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0 5\n"},
    {"m.csm", "$FirstFrame 1\n$LastFrame 1\n$Rate 25\n$Order\na b c\n$Points\n"
              "1 0 0 0 1 0 0 0 1 0\n"},
    {"m.dxf", "0\nSECTION\n2\nENTITIES\n0\n3DFACE\n8\nl\n10\n0\n20\n0\n30\n0\n11\n1\n21\n"
              "0\n31\n0\n12\n0\n22\n1\n32\n0\n13\n0\n23\n1\n33\n0\n0\nENDSEC\n0\nEOF\n"},
    {"m.ifc", "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
              "FILE_NAME('t','',(''),(''),'','','');\nFILE_SCHEMA(('IFC2X3'));\nENDSEC;\n"
              "DATA;\n#1=IFCCARTESIANPOINT((0.,0.,0.));\n"
              "#2=IFCAXIS2PLACEMENT3D(#1,$,$);\n#3=IFCLOCALPLACEMENT($,#2);\n"
              "#4=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n#5=IFCUNITASSIGNMENT((#4));\n"
              "#6=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#2,$);\n"
              "#7=IFCPROJECT('p',#10,'t',$,$,$,$,(#6),#5);\n"
              "#8=IFCSITE('s',#10,'t',$,$,#3,$,$,.ELEMENT.,$,$,$,$,$);\n"
              "#9=IFCRELAGGREGATES('r',#10,$,$,#7,(#8));\n"
              "#10=IFCOWNERHISTORY(#13,#14,$,.ADDED.,$,$,$,0);\n"
              "#11=IFCPERSON('i','n','',$,$,$,$,$);\n#12=IFCORGANIZATION($,'o',$,$,$);\n"
              "#13=IFCPERSONANDORGANIZATION(#11,#12,$);\n"
              "#14=IFCAPPLICATION(#12,'1','a','a');\nENDSEC;\nEND-ISO-10303-21;\n"},
    {"m.irrmesh", "<?xml version=\"1.0\"?>\n<mesh>\n<buffer>\n<material>\n<colour name="
                  "\"Ambient\" value=\"ffffffff\"/>\n</material>\n<vertices type=\""
                  "standard\" vertexCount=\"3\">\n0 0 0 0 0 1 ffffffff 0 0\n"
                  "1 0 0 0 0 1 ffffffff 1 0\n0 1 0 0 0 1 ffffffff 0 1\n</vertices>\n"
                  "<indices indexCount=\"3\">\n0 1 2\n</indices>\n</buffer>\n</mesh>\n"},
    {"m.irr", "<?xml version=\"1.0\"?>\n<irr_scene>\n<node type=\"cube\">\n<attributes>\n"
              "<float name=\"Size\" value=\"2\"/>\n<vector3d name=\"Position\" value=\""
              "0, 1, 0\"/>\n</attributes>\n<materials>\n<attributes>\n<enum name=\"Type\""
              " value=\"solid\"/>\n</attributes>\n</materials>\n</node>\n</irr_scene>\n"},
    {"m.lws", "LWSC\n3\nFirstFrame 0\nLastFrame 1\nFramesPerSecond 25\n"
              "AddNullObject a\nNumChannels 1\nChannel 0\n{ Envelope\n1\nKey 1 0 0 0 0 0 "
              "0 0 0\nBehaviors 1 1\n}\nAddCamera\nCameraName c\n"},
    {"m.md5mesh",
     "MD5Version 10\ncommandline \"\"\nnumJoints 1\nnumMeshes 1\njoints {\n"
     "\"a\" -1 ( 0 0 0 ) ( 0 0 0 )\n}\nmesh {\nshader \"m\"\nnumverts 3\n"
     "vert 0 ( 0 0 ) 0 1\nvert 1 ( 1 0 ) 1 1\nvert 2 ( 0 1 ) 2 1\nnumtris 1\n"
     "tri 0 0 1 2\nnumweights 3\nweight 0 0 1 ( 0 0 0 )\n"
     "weight 1 0 1 ( 1 0 0 )\nweight 2 0 1 ( 0 1 0 )\n}\n"},
    {"m.nff", "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 8 8\n"
              "f 1 1 1 1 0 0 0\np 3\n0 0 0\n1 0 0\n0 1 0\ns 0 0 0 1\nc\n0 0 0 1\n"
              "0 2 0 0.5\n"},
    {"m.enff",
     "nff\nversion 2\nviewpos 0 0 5\nviewdir 0 0 -1\nt\n3\n0 0 0\n1 0 0\n0 1 0\n"
     "1\n3 0 1 2 0xfff both\n"},
    {"m.smd", "version 1\nnodes\n0 \"a\" -1\nend\nskeleton\ntime 0\n0 0 0 0 0 0 0\nend\n"
              "triangles\nm.bmp\n0 0 0 0 0 0 1 0 0\n0 1 0 0 0 0 1 1 0\n"
              "0 0 1 0 0 0 1 0 1 1 0 1\nend\n"},
    {"m.x3d", "<?xml version=\"1.0\"?>\n<X3D profile=\"Interchange\" version=\"3.0\">\n"
              "<Scene>\n<Transform translation=\"0 1 0\">\n<Shape>\n<IndexedFaceSet "
              "coordIndex=\"0 1 2 -1\">\n<Coordinate point=\"0 0 0 1 0 0 0 1 0\"/>\n"
              "</IndexedFaceSet>\n</Shape>\n<Shape><Box size=\"1 1 1\"/></Shape>\n"
              "</Transform>\n</Scene>\n</X3D>\n"},
    {"m.xgl", "<WORLD>\n<LIGHTING><AMBIENT>1,1,1</AMBIENT></LIGHTING>\n<OBJECT>\n"
              "<TRANSFORM><FORWARD>0,0,1</FORWARD><UP>0,1,0</UP><POSITION>0,0,0"
              "</POSITION></TRANSFORM>\n<MESH ID=\"1\">\n<MAT ID=\"1\"><DIFF>1,1,1</DIFF>"
              "</MAT>\n<P ID=\"1\">0,0,0</P>\n<P ID=\"2\">1,0,0</P>\n<P ID=\"3\">0,1,0"
              "</P>\n<F><MATREF>1</MATREF><FV1><PREF>1</PREF></FV1><FV2><PREF>2</PREF>"
              "</FV2><FV3><PREF>3</PREF></FV3></F>\n</MESH>\n</OBJECT>\n</WORLD>\n"},
    {"m.amf", "<?xml version=\"1.0\"?>\n<amf unit=\"meter\">\n<object id=\"0\">\n<mesh>\n"
              "<vertices>\n<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates>"
              "</vertex>\n<vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates>"
              "</vertex>\n<vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates>"
              "</vertex>\n</vertices>\n<volume>\n<triangle><v1>0</v1><v2>1</v2><v3>2</v3>"
              "</triangle>\n</volume>\n</mesh>\n</object>\n</amf>\n"},
    {"m.mesh.xml", "<mesh>\n<submeshes>\n<submesh material=\"m\" usesharedvertices=\""
                   "false\" use32bitindexes=\"false\" operationtype=\"triangle_list\">\n"
                   "<faces count=\"1\"><face v1=\"0\" v2=\"1\" v3=\"2\"/></faces>\n"
                   "<geometry vertexcount=\"3\"><vertexbuffer positions=\"true\">\n"
                   "<vertex><position x=\"0\" y=\"0\" z=\"0\"/></vertex>\n"
                   "<vertex><position x=\"1\" y=\"0\" z=\"0\"/></vertex>\n"
                   "<vertex><position x=\"0\" y=\"1\" z=\"0\"/></vertex>\n"
                   "</vertexbuffer></geometry>\n</submesh>\n</submeshes>\n</mesh>\n"},
    {"m.ogex",
     "Metric (key = \"distance\") {float {1}}\nMetric (key = \"up\") {string "
     "{\"y\"}}\nGeometryNode $node1 {\nName {string {\"t\"}}\nObjectRef {ref "
     "{$geometry1}}\nTransform {float[16] {{1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1}}}"
     "\n}\nGeometryObject $geometry1 {\nMesh (primitive = \"triangles\") {\n"
     "VertexArray (attrib = \"position\") {float[3] {{0,0,0},{1,0,0},{0,1,0}}}\n"
     "IndexArray {unsigned_int32[3] {{0,1,2}}}\n}\n}\n"},
    {"m.cob", "Caligari V00.01ALH             \nPolH V0.06 Id 1 Parent 0 Size 00000300\n"
              "Name t,0\ncenter 0 0 0\nx axis 1 0 0\ny axis 0 1 0\nz axis 0 0 1\n"
              "Transform\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\nWorld Vertices 3\n0 0 0\n"
              "1 0 0\n0 1 0\nTexture Vertices 1\n0 0\nFaces 1\nFace verts 3 flags 0 mat 0"
              "\n<0,0> <1,0> <2,0>\nDrawFlags 0\nEND  V1.00 Id 0 Parent 0 Size 0\n"},
};

/* Begins of files whose readers want more than a few bytes. */
static const struct {
    const char *name, *head;
} heads[] = {
    {"m.md3", "IDP3\x0f"},
    {"m.mdl", "IDPO\x06"},
    {"m.mdc", "IDPC\x02"},
    {"m.hmp", "HMP7"},
    {"m.ndo", "nendo 1.1"},
    {"m.q3o", "quick3Do\x64"},
    {"m.blend", "BLENDER-v279"},
    {"m.sib", "\x80SIB"},
    {"m.iqm", "INTERQUAKEMODEL"},
    {"m.pmx", "PMX "},
    {"m.3d", "\x03"},
    {"m.mesh", "\x10[MeshSerializer_v1.8]\n"},
    {"m.pk3", "PK\x03\x04"},
    {"m.x3db", "\xe0\x01"},
};

/* A file being written, little- or big-endian. */
typedef struct bytes {
    uint8_t data[1024];
    size_t size;
    bool big;
} bytes;

static void put(bytes *b, uint32_t value, int size)
{
    for (int i = 0; i < size; i++)
        b->data[b->size++] = (uint8_t)(value >> (8 * (b->big ? size - 1 - i : i)));
}

static void put_float(bytes *b, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(b, bits, 4);
}

static void put_text(bytes *b, const char *text, size_t size)
{
    for (size_t i = 0; i < size; i++)
        b->data[b->size++] = (uint8_t)(i < strlen(text) ? text[i] : '\0');
}

/* The corners of the triangle, three floats each. */
static void put_corner(bytes *b, int corner)
{
    put_float(b, corner == 1 ? 1.0f : 0.0f);
    put_float(b, corner == 2 ? 1.0f : 0.0f);
    put_float(b, 0.0f);
}

/* A chunk's size before its bytes; end_chunk() fills it in. */
static size_t begin_chunk(bytes *b, const char *name)
{
    put_text(b, name, 4);
    put(b, 0, 4);
    return b->size;
}

static void end_chunk(bytes *b, size_t begin)
{
    const size_t end = b->size;
    b->size = begin - 4;
    put(b, (uint32_t)(end - begin), 4);
    b->size = end;
}

static void write_md2(void)
{
    bytes b = {0};
    const uint32_t words[] = {8, 1, 1,  40 + 12, 0,  3,  1,  1,
                              0, 1, 68, 68,      72, 84, 68, 136};
    put_text(&b, "IDP2", 4);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        put(&b, words[i], 4);
    put(&b, 0, 4); /* a texture coordinate */
    for (uint32_t i = 0; i < 3; i++)
        put(&b, i, 2);
    for (int i = 0; i < 3; i++)
        put(&b, 0, 2);
    for (int i = 0; i < 6; i++)
        put_float(&b, i < 3 ? 1.0f : 0.0f);
    put_text(&b, "frame", 16);
    put(&b, 0x00000000, 4);
    put(&b, 0x00000001, 4);
    put(&b, 0x00000100, 4);
    put_text(&b, "", 64); /* the reader wants more than it needs */
    seeds_write_model("m.md2", b.data, b.size);
}

static void write_ms3d(void)
{
    bytes b = {0};
    put_text(&b, "MS3D000000", 10);
    put(&b, 4, 4);
    put(&b, 3, 2);
    for (int i = 0; i < 3; i++) {
        put(&b, 0, 1);
        put_corner(&b, i);
        put(&b, 0xff, 1); /* no bone */
        put(&b, 1, 1);
    }
    put(&b, 1, 2);
    put(&b, 0, 2);
    for (uint32_t i = 0; i < 3; i++)
        put(&b, i, 2);
    for (int i = 0; i < 9 + 6; i++)
        put_float(&b, i % 3 == 2 ? 1.0f : 0.0f);
    put(&b, 1, 1);
    put(&b, 0, 1);
    put(&b, 1, 2);
    put(&b, 0, 1);
    put_text(&b, "group", 32);
    put(&b, 1, 2);
    put(&b, 0, 2);
    put(&b, 0xff, 1); /* no material */
    put(&b, 0, 2);
    put_float(&b, 24.0f);
    put_float(&b, 0.0f);
    put(&b, 1, 4);
    put(&b, 0, 2);
    seeds_write_model("m.ms3d", b.data, b.size);
}

static void write_lwo(void)
{
    bytes b = {.big = true};
    const size_t form = begin_chunk(&b, "FORM");
    put_text(&b, "LWO2", 4);
    size_t chunk = begin_chunk(&b, "TAGS");
    put_text(&b, "m", 2);
    end_chunk(&b, chunk);
    chunk = begin_chunk(&b, "LAYR");
    put(&b, 0, 4);
    for (int i = 0; i < 3; i++)
        put_float(&b, 0.0f);
    put_text(&b, "t", 2);
    end_chunk(&b, chunk);
    chunk = begin_chunk(&b, "PNTS");
    for (int i = 0; i < 3; i++)
        put_corner(&b, i);
    end_chunk(&b, chunk);
    chunk = begin_chunk(&b, "POLS");
    put_text(&b, "FACE", 4);
    put(&b, 3, 2);
    for (uint32_t i = 0; i < 3; i++)
        put(&b, i, 2);
    end_chunk(&b, chunk);
    chunk = begin_chunk(&b, "PTAG");
    put_text(&b, "SURF", 4);
    put(&b, 0, 4);
    end_chunk(&b, chunk);
    chunk = begin_chunk(&b, "SURF");
    put_text(&b, "m", 2);
    put(&b, 0, 2);
    end_chunk(&b, chunk);
    end_chunk(&b, form);
    seeds_write_model("m.lwo", b.data, b.size);
}

static void write_b3d(void)
{
    bytes b = {0};
    const size_t whole = begin_chunk(&b, "BB3D");
    put(&b, 1, 4);
    const size_t node = begin_chunk(&b, "NODE");
    put_text(&b, "t", 2);
    for (int i = 0; i < 10; i++) /* position, scale, rotation w x y z */
        put_float(&b, i >= 3 && i < 7 ? 1.0f : 0.0f);
    const size_t mesh = begin_chunk(&b, "MESH");
    put(&b, 0xffffffff, 4);
    size_t chunk = begin_chunk(&b, "VRTS");
    put(&b, 0, 4);
    put(&b, 0, 4);
    put(&b, 0, 4);
    for (int i = 0; i < 3; i++)
        put_corner(&b, i);
    end_chunk(&b, chunk);
    chunk = begin_chunk(&b, "TRIS");
    put(&b, 0xffffffff, 4);
    for (uint32_t i = 0; i < 3; i++)
        put(&b, i, 4);
    end_chunk(&b, chunk);
    end_chunk(&b, mesh);
    end_chunk(&b, node);
    end_chunk(&b, whole);
    seeds_write_model("m.b3d", b.data, b.size);
}

static void write_ter(void)
{
    bytes b = {0};
    put_text(&b, "TERRAGENTERRAIN SIZE", 20);
    put(&b, 1, 2);
    put(&b, 0, 2);
    put_text(&b, "ALTW", 4);
    put(&b, 16, 2);
    put(&b, 0, 2);
    for (uint32_t i = 0; i < 4; i++)
        put(&b, 100 * i, 2);
    put_text(&b, "EOF ", 32);
    seeds_write_model("m.ter", b.data, b.size);
}

void seeds_write_for_readers(void)
{
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        seeds_write_model(texts[i].name, texts[i].text, strlen(texts[i].text));
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
        char data[512] = {0};
        memcpy(data, heads[i].head, strlen(heads[i].head));
        seeds_write_model(heads[i].name, data, sizeof data);
    }
    write_md2();
    write_ms3d();
    write_lwo();
    write_b3d();
    write_ter();
}
