// name: storages
// kind: table
// description: Which storages are there, and which kinds of data do they hold?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns storage: string, name of the storage
// returns holds: list of string, kinds of data that get there
// returns pseudonymised: list of string, kinds that get there pseudonymised, broader ones too
// returns written_by: list of string, who writes personal data to it
// returns read_by: list of string, who gets personal data from it
// order: robot, storage
MATCH (e:Storage)
WHERE $robot = '' OR e.robot = $robot
CALL (e) {
  UNWIND coalesce(e.begins, []) + COLLECT { MATCH ()-[i:FLOWS_TO]->(e)
    UNWIND coalesce(i.passes, []) + coalesce(i.begins, []) + coalesce(i.made, []) AS kind RETURN DISTINCT kind } AS kind
  WITH DISTINCT kind ORDER BY kind
  RETURN collect(kind) AS holds
}
RETURN e.robot AS robot, e.name AS storage, holds, coalesce(e.pseudonymised, []) AS pseudonymised,
       COLLECT { MATCH (n:Element)-[f:FLOWS_TO]->(e) WHERE size(f.carries) > 0
                 RETURN DISTINCT n.name AS name ORDER BY name } AS written_by,
       COLLECT { MATCH (n:Element)<-[f:FLOWS_TO]-(e) WHERE size(f.carries) > 0
                 RETURN DISTINCT n.name AS name ORDER BY name } AS read_by
ORDER BY robot, storage
