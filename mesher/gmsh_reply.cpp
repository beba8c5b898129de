#include "gmsh_reply.hpp"

#include <cstdint>
#include <stdexcept>

#include "byte_stream.hpp"
#include "plain_text.hpp"

namespace suffuse {

namespace {

void write(ByteWriter& to, const GmshModel& model) {
  to.number(model.dimension);
  to.numbers(model.node_tags);
  to.numbers(model.coordinates);
  to.number<std::uint64_t>(model.entities.size());
  for (const GmshEntity& entity : model.entities) {
    to.number(entity.dimension);
    to.number(entity.tag);
    to.number(entity.box);
    to.number<std::uint64_t>(entity.elements.size());
    for (const GmshElements& block : entity.elements) {
      to.number(block.type);
      to.text(block.type_name);
      to.number(block.nodes_each);
      to.numbers(block.tags);
      to.numbers(block.nodes);
    }
  }
  to.number<std::uint64_t>(model.groups.size());
  for (const GmshGroup& group : model.groups) {
    to.number(group.dimension);
    to.number(group.tag);
    to.text(group.name);
    to.numbers(group.entities);
    to.numbers(group.nodes);
  }
}

GmshElements read_elements(ByteReader& from) {
  GmshElements block;
  block.type = from.number<int>();
  block.type_name = from.text();
  block.nodes_each = from.number<int>();
  block.tags = from.numbers<std::size_t>();
  block.nodes = from.numbers<std::size_t>();
  return block;
}

GmshModel read_model(ByteReader& from) {
  GmshModel model;
  model.dimension = from.number<int>();
  model.node_tags = from.numbers<std::size_t>();
  model.coordinates = from.numbers<double>();
  for (std::size_t left = from.count(); left > 0; --left) {
    GmshEntity entity;
    entity.dimension = from.number<int>();
    entity.tag = from.number<int>();
    entity.box = from.number<std::array<double, 6>>();
    for (std::size_t blocks = from.count(); blocks > 0; --blocks) {
      entity.elements.push_back(read_elements(from));
    }
    model.entities.push_back(std::move(entity));
  }
  for (std::size_t left = from.count(); left > 0; --left) {
    GmshGroup group;
    group.dimension = from.number<int>();
    group.tag = from.number<int>();
    group.name = from.text();
    group.entities = from.numbers<int>();
    group.nodes = from.numbers<std::size_t>();
    model.groups.push_back(std::move(group));
  }
  return model;
}

InputProblem read_problem(ByteReader& from) {
  InputProblem problem;
  for (std::string* part :
       {&problem.where, &problem.key, &problem.found, &problem.expected, &problem.suggestion}) {
    *part = plain_text(from.text());
  }
  return problem;
}

[[noreturn]] void refuse_reply(const std::string& defect) {
  throw InputError(std::vector<InputProblem>{
      {"", "", "over which Gmsh hands back " + defect, "a file that Gmsh can mesh", ""}});
}

}  // namespace

std::string bytes_of(const GmshReply& reply) {
  ByteWriter to;
  to.number<std::uint64_t>(reply.problems.size());
  for (const InputProblem& problem : reply.problems) {
    for (const std::string* part :
         {&problem.where, &problem.key, &problem.found, &problem.expected, &problem.suggestion}) {
      to.text(*part);
    }
  }
  to.number<std::uint8_t>(reply.meshes_itself ? 1 : 0);
  to.number<std::uint8_t>(reply.wants_threads ? 1 : 0);
  to.number(reply.default_size);
  for (const bool limit : {reply.limits.smallest, reply.limits.largest, reply.limits.field}) {
    to.number<std::uint8_t>(limit ? 1 : 0);
  }
  write(to, reply.model);
  return to.take();
}

GmshReply reply_from(std::string_view bytes) {
  GmshReply reply;
  try {
    ByteReader from(bytes);
    for (std::size_t left = from.count(); left > 0; --left) {
      reply.problems.push_back(read_problem(from));
    }
    reply.meshes_itself = from.number<std::uint8_t>() != 0;
    reply.wants_threads = from.number<std::uint8_t>() != 0;
    reply.default_size = from.number<double>();
    for (bool* limit : {&reply.limits.smallest, &reply.limits.largest, &reply.limits.field}) {
      *limit = from.number<std::uint8_t>() != 0;
    }
    reply.model = read_model(from);
    if (!from.is_at_end()) refuse_reply("more than a mesh");
  } catch (const std::out_of_range&) {
    refuse_reply("a part of a mesh");
  }
  const std::string defect = gmsh_model_defect(reply.model);
  if (reply.problems.empty() && !defect.empty()) refuse_reply(defect);
  return reply;
}

}  // namespace suffuse
