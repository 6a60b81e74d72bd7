// name: mixed-enclaves
// kind: table
// description: Which enclaves hold a source and a leak of one kind of data, or a sanitizer beside one of these?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns enclave: string, path of the enclave
// returns category: string, a kind of data that begins at one of its nodes, or gets to it
// returns sources: list of string, nodes that bring it in or make it of other data
// returns leaks: list of string, nodes that let it out
// returns sanitizers: list of string, nodes that clean it
// order: robot, enclave, category
MATCH (v:Enclave)
WHERE $robot = '' OR v.robot = $robot
CALL (v) {
  MATCH (v)<-[:IN_ENCLAVE]-(n:Element)
  WITH DISTINCT n ORDER BY n.name
  WITH n, COLLECT { MATCH (n)-[:DERIVES]->(c:DataCategory) RETURN DISTINCT c.name } AS makes,
       COLLECT { MATCH ()-[i:FLOWS_TO]->(n)
                 UNWIND coalesce(i.passes, []) + coalesce(i.begins, []) + coalesce(i.made, []) AS kind
                 RETURN DISTINCT kind } AS gets
  WITH collect({name: n.name, brings: coalesce(n.begins, []) + makes, leaks: coalesce(n.leaks, []),
                cleans: coalesce(n.sanitizes, []), gets: gets}) AS nodes
  UNWIND nodes AS n
  UNWIND n.brings + [kind IN n.gets WHERE kind IN n.leaks + n.cleans] AS category
  WITH DISTINCT nodes, category
  WITH category, [n IN nodes WHERE category IN n.brings | n.name] AS sources,
       [n IN nodes WHERE category IN n.leaks | n.name] AS leaks,
       [n IN nodes WHERE category IN n.cleans | n.name] AS sanitizers
  WHERE size(sources) > 0 AND size(leaks) > 0 OR size(sanitizers) > 0 AND size(sources) + size(leaks) > 0
  WITH * WHERE any(n IN sources + leaks + sanitizers WHERE n <> (sources + leaks)[0])  // two different nodes
  RETURN category, sources, leaks, sanitizers
}
RETURN v.robot AS robot, v.path AS enclave, category, sources, leaks, sanitizers
ORDER BY robot, enclave, category
