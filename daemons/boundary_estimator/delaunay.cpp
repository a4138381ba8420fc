#include "daemons/boundary_estimator/delaunay.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace hairpin {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<int, Kernel>;
using Delaunay =
    CGAL::Delaunay_triangulation_2<Kernel,
                                   CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;

}  // namespace

Triangulation Triangulate(const std::vector<Eigen::Vector2d>& points) {
  Delaunay delaunay;
  Delaunay::Face_handle hint;
  for (size_t i = 0; i < points.size(); ++i) {
    const size_t known = delaunay.number_of_vertices();
    const auto vertex = delaunay.insert({points[i].x(), points[i].y()}, hint);
    if (delaunay.number_of_vertices() > known) vertex->info() = static_cast<int>(i);
    hint = vertex->face();
  }
  Triangulation result;
  if (delaunay.dimension() < 2) return result;
  for (auto face = delaunay.all_faces_begin(); face != delaunay.all_faces_end(); ++face) {
    face->info() = Triangulation::kOutside;
  }
  int count = 0;
  for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face)
    face->info() = count++;
  result.triangles.reserve(static_cast<size_t>(count));
  for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face) {
    Triangulation::Triangle& triangle = result.triangles.emplace_back();
    for (int i = 0; i < 3; ++i) {
      triangle.vertex[static_cast<size_t>(i)] = face->vertex(i)->info();
      triangle.neighbour[static_cast<size_t>(i)] = face->neighbor(i)->info();
    }
  }
  return result;
}

}  // namespace hairpin
