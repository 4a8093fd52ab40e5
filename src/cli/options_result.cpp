#include <sunfleck/core/names.hpp>
#include <sunfleck/view/export.hpp>
#include <sunfleck/view/stored.hpp>

#include "cli/options.hpp"
#include "cli/validators.hpp"

namespace sunfleck {

void define_export(CLI::App& verb, ExportOptions& o) {
  verb.add_option("RESULT", o.result, "result of 'sunfleck solve', HDF5")->required()->type_name("");
  verb.add_option("-o,--output", o.output,
                  "file to write: .ply, .obj, .glb, .vtkhdf and .xdmf are lit meshes, .csv a table per organ, .opf a plant with its light "
                  "as attributes")
      ->required()
      ->type_name("FILE");
  verb.add_option("--quantity", o.quantity,
                  "mesh only: what colours show: 'colour' (natural, the default), or a map of one of " + joined(mesh_quantities()))
      ->type_name("NAME");
  verb.add_option("--band", o.band, "mesh only: the band of that map (default PAR, else the first)")->type_name("NAME");
  verb.add_option("--state", o.state,
                  "mesh only: the one lighting state to keep, by name or number from 1 (default all, coloured by the first)")
      ->type_name("NAME");
  verb.add_option(
          "--by", o.by,
          "table only: sums of organs by plant, placement, type, name, order, layer (or layer:DEPTH, in metres), or any attribute of the "
          "plants; several are separated by commas")
      ->type_name("KEYS");
  verb.add_option("--sensor", o.sensors,
                  "table only: a row for each cell of this sensor in the place of organs; may be repeated, 'all' takes every sensor")
      ->type_name("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb.add_option("--copy", o.copy, ".opf only: which copy of a plant, by its placement, such as 'coffee[3]' (default the only one)")
      ->type_name("PLACEMENT");
  verb.add_option("--original", o.original,
                  ".opf only: copy this OPF as it is and add the attributes (default: write the plant from the result)")
      ->type_name("PLANT.opf");
  verb.footer(
      "Units: irradiance and absorbed light of facets [W m^-2], absorbed light of organs [W], areas [m^2], lengths [m].\n\n"
      "Examples:\n"
      "  sunfleck export stand.h5 -o stand.ply\n"
      "  sunfleck export stand.h5 -o stand.glb --quantity absorbed --band NIR\n"
      "  sunfleck export stand.h5 -o organs.csv\n"
      "  sunfleck export stand.h5 -o profile.csv --by type,layer:0.5\n"
      "  sunfleck export chamber.h5 -o bench.csv --sensor bench");
}

void define_info(CLI::App& verb, InfoOptions& o) {
  verb.add_option("FILE", o.file, "a result, a plant (.opf .obj .ply .can .h5), a species or a scene (.toml)")->required()->type_name("");
  verb.add_flag("--json", o.json, "print JSON instead of text");
  verb.footer(
      "Examples:\n"
      "  sunfleck info stand.h5\n"
      "  sunfleck info plants/poplar.toml --json");
}

namespace {

void define_camera(CLI::App& verb, CameraOptions& o) {
  auto* eye = verb.add_option("--eye", o.eye, "camera position [m] (default as near as all plants are in the picture)")
                  ->expected(3)
                  ->type_name("X Y Z")
                  ->check(number_between(-unlimited, unlimited));
  verb.add_option("--target", o.target, "point that the camera looks at [m] (default the middle of the plants)")
      ->expected(3)
      ->type_name("X Y Z")
      ->check(number_between(-unlimited, unlimited));
  verb.add_option("--azimuth", o.azimuth_deg, "where the camera stands [degrees from north over east] (default 150)")
      ->type_name("DEGREES")
      ->check(number_between(-360, 360))
      ->excludes(eye);
  verb.add_option("--elevation", o.elevation_deg, "height of the camera above the horizon [degrees] (default 25)")
      ->type_name("DEGREES")
      ->check(number_between(-90, 90))
      ->excludes(eye);
  verb.add_option("--fov,--field-of-view", o.field_of_view_deg, "vertical opening of the camera [degrees] (default 35)")
      ->type_name("DEGREES")
      ->check(number_between(1, 120));
  verb.add_flag("--orthographic", o.orthographic, "parallel projection instead of perspective");
  verb.add_option("--width", o.width, "pixels (default 1200)")->type_name("N")->check(count_from(16, 16384));
  verb.add_option("--height", o.height, "pixels (default 900)")->type_name("N")->check(count_from(16, 16384));
  verb.add_option("--samples", o.samples, "rays per pixel, rounded up to a square number (default " + std::to_string(o.samples) + ")")
      ->type_name("N")
      ->check(count_from(1, 1024));
}

}  // namespace

void define_render(CLI::App& verb, RenderOptions& o) {
  verb.add_option("RESULT", o.result, "result of 'sunfleck solve', HDF5")->required()->type_name("");
  verb.add_option("-o,--output", o.output,
                  "picture to write; .exr keeps light before tone mapping, depth, and the rows of organs and facets")
      ->required()
      ->type_name("IMAGE.png|.exr");
  verb.add_option("--quantity", o.quantity,
                  "what is drawn: 'colour' (natural colour, the default), or a map with a legend of one of " + joined(quantity_names()))
      ->type_name("NAME")
      ->check(one_of(quantity_names()));
  verb.add_option("--band", o.band, "band of a map (default PAR, else the first), or the one band that natural colour is made from")
      ->type_name("NAME");
  verb.add_option("--rgb", o.rgb,
                  "bands that natural colour takes as red, green and blue (default those named R, G, B, else PAR in leaf colours)")
      ->expected(3)
      ->type_name("RED GREEN BLUE");
  verb.add_option("--reference", o.reference, "result that 'error' and 'organ_error' compare with")->type_name("RESULT.h5");
  verb.add_option("--state", o.state, "lighting state, by name or by number from 1 (default the first)")->type_name("NAME");
  verb.add_option("--colormap", o.colormap, "colours of a map: " + joined(color_map_names()) + " (default viridis; difference for errors)")
      ->type_name("NAME")
      ->check(one_of(color_map_names()));
  verb.add_option("--range", o.range, "lowest and highest value of a map, in the quantity's unit (default from the data)")
      ->expected(2)
      ->type_name("LOW HIGH")
      ->check(number_between(-unlimited, unlimited));
  verb.add_flag("--log", o.logarithmic, "logarithmic map");
  define_camera(verb, o);
  verb.add_flag_callback(
      "--no-ground", [&o] { o.ground = false; }, "leave out the ground");
  verb.add_flag("--map-ground", o.map_ground, "colour the ground of a map by its values too");
  verb.add_flag("--infinite", o.infinite, "draw a periodic scene with its repetition to the horizon");
  verb.add_option("--views", o.views, "several views in one picture, separated by commas: some of " + joined(view_names()))
      ->delimiter(',')
      ->type_name("NAME,...");
  verb.add_option("--cut", o.cut,
                  "takes away the plants on the camera's side of a plane across an axis, such as y=0.5, or on the side that a normal "
                  "points to, given by a point and the normal: x,y,z,nx,ny,nz [m]")
      ->type_name("PLANE");
  verb.add_option("--background", o.background, "what is behind the scene: 'sky' (the default) or 'white'")
      ->type_name("NAME")
      ->check(one_of({"sky", "white"}));
  verb.add_option("--exposure", o.exposure_stops, "natural colour brighter or darker by so many factors of two (default 0)")
      ->type_name("STOPS")
      ->check(number_between(-20, 20));
  verb.add_flag("--scale-bar", o.scale_bar, "a bar of a round length in parallel projections");
  verb.footer(
      "Examples:\n"
      "  sunfleck render stand.h5 -o stand.png\n"
      "  sunfleck render stand.h5 -o par.png --quantity absorbed --band PAR --elevation 20 --map-ground\n"
      "  sunfleck render stand.h5 -o views.png --views camera,front,top --scale-bar --background white\n"
      "  sunfleck render stand.h5 -o cut.png --quantity sunlit --cut y=0.2\n"
      "  sunfleck render draft.h5 -o error.png --quantity organ_error --reference fine.h5");
}

void define_preview(CLI::App& verb, PreviewOptions& o) {
  verb.add_option("SCENE", o.scene, "scene file, TOML")->required()->type_name("");
  verb.add_option("-o,--output", o.output, "picture to write")->required()->type_name("IMAGE.png");
  verb.add_option("--state", o.state, "lighting state, by name or by number from 1 (default the first)")->type_name("NAME");
  define_camera(verb, o);
  verb.add_option("--threads", o.threads, "threads to use; 0 is all cores")->type_name("N")->check(count_from(0, 4096));
  verb.footer(
      "Shadows of the sun are traced, sky light is estimated from the shape of crowns ('solve --method occlusion'), scattered light is a\n"
      "constant: to see whether plants stand upright and where they should. It says on the picture that it is a preview.\n\n"
      "Examples:\n"
      "  sunfleck preview field.toml -o field.png\n"
      "  sunfleck preview field.toml -o top.png --elevation 90 --orthographic");
}

void define_view(CLI::App& verb, ViewOptions& o) {
  verb.add_option("RESULT", o.result, "result of solve, .h5; or a scene, .toml, of which a preview is shown")->required()->type_name("");
  verb.add_option("OTHER", o.other, "a second result, to compare with the first")->type_name("");
  verb.add_option("--port", o.port, "port to serve on (default any that is free)")->type_name("N")->check(count_from(1, 65535));
  verb.add_option("--listen", o.listen, "address to serve on instead of this machine's loopback; needs --token")->type_name("ADDRESS");
  verb.add_option("--token", o.token, "what a browser must know to be answered: 16 letters and digits or more, or 'new' for a random one")
      ->type_name("TOKEN")
      ->envname("SUNFLECK_TOKEN");
  verb.footer(
      "Prints the address to open in a browser, and serves until it is stopped (Ctrl-C).\n"
      "Examples:\n"
      "  sunfleck view stand.h5\n"
      "  sunfleck view field.toml                  # before any solve: sun by rays, sky by occlusion, a constant for scattered light\n"
      "  sunfleck view standard.h5 reference.h5\n"
      "  sunfleck view stand.h5 --port 8600        # on a remote machine; here: ssh -L 8600:localhost:8600 THAT_MACHINE");
}

}  // namespace sunfleck
