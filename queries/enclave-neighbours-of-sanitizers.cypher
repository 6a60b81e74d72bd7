// name: enclave-neighbours-of-sanitizers
// kind: table
// description: Which nodes share an enclave with a sanitizer, so that they could take its data and pass it on?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns enclave: string, path of the enclave
// returns sanitizer: string, name of the sanitizer
// returns category: string, the kind of data that gets to it and that it cleans
// returns neighbours: list of string, nodes beside it that no label says to end the category
// returns already: list of string, those of them that get the category by their own profile too
// returns reads: list of string, channels from which the sanitizer, and so its enclave, may take the category
// returns writes: list of string, channels that the enclave may write to and that can carry the category
// order: robot, enclave, sanitizer, category
MATCH (:DataCategory)<-[:SANITIZES]-(e:Element)
WHERE $robot = '' OR e.robot = $robot
WITH DISTINCT e
MATCH (e)-[:IN_ENCLAVE]->(v:Enclave)
UNWIND e.sanitizes AS category
WITH e, v, category, '{"enclave": "' + v.path + '", ' AS ours
CALL (e, v, category, ours) {
  MATCH (c:Topic|Service|Action)-[f:FLOWS_TO WHERE category IN f.passes]->(e)
  WHERE f.enclave = v.path OR any(other IN f.further WHERE other STARTS WITH ours)
  WITH DISTINCT c.name AS name ORDER BY name
  RETURN collect(name) AS reads
}
WITH * WHERE size(reads) > 0
CALL (v, category, ours) {
  MATCH (v)<-[:IN_ENCLAVE]-(:Element)-[f:FLOWS_TO]->(c:Topic|Service|Action)
  WHERE coalesce(f.decision, 'allow') <> 'deny' AND NOT category IN coalesce(c.stops, [])
    AND (f.enclave = v.path OR any(other IN f.further WHERE other STARTS WITH ours))
  WITH DISTINCT c.name AS name ORDER BY name
  RETURN collect(name) AS writes
}
WITH * WHERE size(writes) > 0
MATCH (v)<-[:IN_ENCLAVE]-(n:Element)
WHERE n <> e AND NOT category IN coalesce(n.stops, [])
WITH e, v, category, reads, writes, n.name AS neighbour,
     EXISTS { ()-[f:FLOWS_TO WHERE category IN f.passes]->(n) } AS gets ORDER BY neighbour
RETURN v.robot AS robot, v.path AS enclave, e.name AS sanitizer, category, collect(neighbour) AS neighbours,
       collect(CASE WHEN gets THEN neighbour END) AS already, reads, writes
ORDER BY robot, enclave, sanitizer, category
